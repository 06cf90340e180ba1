#pragma once
/// A parallel sort that can be cancelled.
#include <tbb/parallel_sort.h>

#include <functional>

#include "voxdag/parallel/polled_for.hpp"

namespace voxdag {

/// Sorts [begin, end) on the threads of the current TBB arena. Polls `progress`, which may be null,
/// at each comparison: nothing else happens often enough while sorting. Throws Cancelled; the order
/// is then unspecified.
template <class Iterator, class Less = std::less<>>
void polled_sort(Iterator begin, Iterator end, const Progress* progress, const Less& less = {}) {
  tbb::parallel_sort(begin, end, [progress, &less](const auto& a, const auto& b) {
    poll(progress);
    return less(a, b);
  });
}

}  // namespace voxdag
