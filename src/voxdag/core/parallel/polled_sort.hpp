#pragma once
/// A parallel sort that can be cancelled.
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <functional>

#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/core/thread_sanitizer.hpp"

namespace voxdag {

/// Sorts [begin, end) on the threads of the current TBB arena. Polls `work` at each comparison:
/// nothing else happens often enough while sorting. Throws Cancelled; the order is then
/// unspecified. Builds with ThreadSanitizer sort on one thread. ThreadSanitizer does not see the
/// order of TBB's tasks, and would spend minutes on false reports for the entries.
template <class Iterator, class Less = std::less<>>
void polled_sort(Iterator begin, Iterator end, Work work, const Less& less = {}) {
  const auto polled_less = [work, &less](const auto& a, const auto& b) {
    work.poll();
    return less(a, b);
  };
#ifdef VOXDAG_TSAN
  std::sort(begin, end, polled_less);
#else
  tbb::parallel_sort(begin, end, polled_less);
#endif
}

}  // namespace voxdag
