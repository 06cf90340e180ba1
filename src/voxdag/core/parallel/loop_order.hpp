#pragma once
/// Tells ThreadSanitizer about the order that TBB guarantees: the items of a loop run after
/// everything that the caller did before the loop, and before everything that it does after the
/// loop. ThreadSanitizer cannot see this order, because Debian's TBB is not built with it. Without
/// ThreadSanitizer these types are empty.

#include "voxdag/core/thread_sanitizer.hpp"

#ifdef VOXDAG_TSAN
#include <dlfcn.h>
#include <sanitizer/tsan_interface.h>
#include <tbb/parallel_for.h>

namespace tbb::detail::r1 {

/// Replaces TBB's function that runs a loop and waits for its tasks. Calls TBB's, then shows
/// ThreadSanitizer the order that TBB guarantees: all that the tasks did, up to the last reference
/// that they release, comes before the return. Without it, ThreadSanitizer reports where the caller
/// uses its stack again, because the tasks read the counter there after the items of the loop.
[[gnu::weak]] void execute_and_wait(d1::task& task, d1::task_group_context& task_context,
                                    d1::wait_context& references,
                                    d1::task_group_context& wait_context) {
  static const auto run = reinterpret_cast<decltype(&execute_and_wait)>(
      ::dlsym(RTLD_NEXT,
              "_ZN3tbb6detail2r116execute_and_waitERNS0_2d14taskERNS2_18task_group_contextERNS2_"
              "12wait_contextES6_"));
  struct Order {
    d1::wait_context& references;
    ~Order() { references.reserve(0); }  // an atomic access to the counter, which orders
  } const order{references};
  run(task, task_context, references, wait_context);
}

}  // namespace tbb::detail::r1
#endif

namespace voxdag {

#ifdef VOXDAG_TSAN

/// The caller keeps one alive during the loop.
class LoopOrder {
 public:
  LoopOrder() { __tsan_release(&begin_); }
  ~LoopOrder() { __tsan_acquire(&end_); }
  LoopOrder(const LoopOrder&) = delete;
  LoopOrder& operator=(const LoopOrder&) = delete;

  /// Each task keeps one alive while its items run, also if an item throws.
  class Items {
   public:
    explicit Items(LoopOrder& order) : order_(order) { __tsan_acquire(&order.begin_); }
    ~Items() { __tsan_release(&order_.end_); }
    Items(const Items&) = delete;
    Items& operator=(const Items&) = delete;

   private:
    LoopOrder& order_;
  };

 private:
  char begin_ = 0, end_ = 0;
};

/// A point at which one thread hands data to another in an order that TBB guarantees.
class OrderPoint {
 public:
  void acquire() { __tsan_acquire(&point_); }
  void release() { __tsan_release(&point_); }

  /// A step runs after all that was released, and releases what it did.
  class Step {
   public:
    explicit Step(OrderPoint& point) : point_(point) { point_.acquire(); }
    ~Step() { point_.release(); }
    Step(const Step&) = delete;
    Step& operator=(const Step&) = delete;

   private:
    OrderPoint& point_;
  };

 private:
  char point_ = 0;
};

#else

struct LoopOrder {
  struct Items {
    explicit Items(const LoopOrder&) {}
  };
};

struct OrderPoint {
  void acquire() {}
  void release() {}
  struct Step {
    explicit Step(const OrderPoint&) {}
  };
};

#endif

}  // namespace voxdag
