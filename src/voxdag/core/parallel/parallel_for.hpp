#pragma once
/// Parallel loops. The body is per item, so `return` ends one item.
#include <cstddef>

#ifndef VOXDAG_OWN_THREADS
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "voxdag/core/parallel/loop_order.hpp"
#else
#include "voxdag/core/parallel/thread_pool.hpp"
#endif

namespace voxdag {

#ifndef VOXDAG_OWN_THREADS

/// Calls body(i) for every i in [0, count), in any order, on several threads (thread_count.hpp).
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

#else

template <class Body>
void parallel_for(std::size_t count, std::size_t grain, const Body& body) {
  ThreadPool::instance().run(count, grain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i != end; ++i) body(i);
  });
}

template <class Body>
void parallel_for(std::size_t count, const Body& body) {
  parallel_for(count, 1, body);
}

#endif

}  // namespace voxdag
