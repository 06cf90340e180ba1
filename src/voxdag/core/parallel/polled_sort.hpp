#pragma once
/// A parallel sort that can be cancelled.
#include <algorithm>
#include <functional>

#ifndef VOXDAG_OWN_THREADS
#include <tbb/parallel_sort.h>
#endif

#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/core/parallel/thread_count.hpp"
#include "voxdag/core/thread_sanitizer.hpp"

namespace voxdag {

#ifdef VOXDAG_OWN_THREADS

/// Sorts [begin, end): divides it at its median until there is a part for each thread.
template <class Iterator, class Less>
void sort_parts(Iterator begin, Iterator end, std::size_t threads, const Less& less) {
  constexpr std::ptrdiff_t kSmall = 1 << 14;
  if (threads < 2 || end - begin < kSmall) return std::sort(begin, end, less);
  const Iterator middle = begin + (end - begin) / 2;
  std::nth_element(begin, middle, end, less);
  parallel_for(2, [&](std::size_t part) {
    part == 0 ? sort_parts(begin, middle, threads / 2, less)
              : sort_parts(middle, end, threads - threads / 2, less);
  });
}

#endif

/// Sorts [begin, end) on several threads. Polls `work` at each comparison:
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
#elif defined(VOXDAG_OWN_THREADS)
  sort_parts(begin, end, thread_count(), polled_less);
#else
  tbb::parallel_sort(begin, end, polled_less);
#endif
}

}  // namespace voxdag
