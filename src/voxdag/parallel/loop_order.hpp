#pragma once
/// Tells ThreadSanitizer about the order that TBB guarantees: the items of a loop run after
/// everything that the caller did before the loop, and before everything that it does after the
/// loop. ThreadSanitizer cannot see this order, because Debian's TBB is not built with it. Without
/// ThreadSanitizer these types are empty.

#include "voxdag/core/thread_sanitizer.hpp"

#ifdef VOXDAG_TSAN
#include <sanitizer/tsan_interface.h>
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
