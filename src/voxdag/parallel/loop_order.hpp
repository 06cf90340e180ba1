#pragma once
/// Tells ThreadSanitizer what TBB guarantees: a loop's items run after what its caller did before,
/// and before what its caller does next. The distributions' TBB is not built with ThreadSanitizer,
/// which therefore cannot see it. Without ThreadSanitizer nothing is left of this.

#if defined(__SANITIZE_THREAD__)
#define VOXDAG_TSAN 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define VOXDAG_TSAN 1
#endif
#endif

#ifdef VOXDAG_TSAN
#include <sanitizer/tsan_interface.h>
#endif

namespace voxdag {

#ifdef VOXDAG_TSAN

/// Lives in the caller, around the loop.
class LoopOrder {
 public:
  LoopOrder() { __tsan_release(&begin_); }
  ~LoopOrder() { __tsan_acquire(&end_); }
  LoopOrder(const LoopOrder&) = delete;
  LoopOrder& operator=(const LoopOrder&) = delete;

  /// Lives around items, however they end.
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

#else

struct LoopOrder {
  struct Items {
    explicit Items(const LoopOrder&) {}
  };
};

#endif

}  // namespace voxdag
