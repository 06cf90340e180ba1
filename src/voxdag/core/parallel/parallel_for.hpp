#pragma once
/// Parallel loops. The body is per item, so `return` ends one item.
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>

#include "voxdag/core/parallel/loop_order.hpp"

namespace voxdag {

/// Calls body(i) for every i in [0, count), in any order, on the threads of the current TBB arena.
/// `grain` is the smallest number of items of a task.
template <class Body>
void parallel_for(std::size_t count, std::size_t grain, const Body& body) {
  LoopOrder order;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, grain),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      const LoopOrder::Items items(order);
                      for (std::size_t i = range.begin(); i != range.end(); ++i) body(i);
                    });
}

/// Calls body(i) for every i in [0, count), one item per task. For a small number of expensive
/// items.
template <class Body>
void parallel_for(std::size_t count, const Body& body) {
  LoopOrder order;
  tbb::parallel_for(std::size_t{0}, count, [&](std::size_t i) {
    const LoopOrder::Items items(order);
    body(i);
  });
}

}  // namespace voxdag
