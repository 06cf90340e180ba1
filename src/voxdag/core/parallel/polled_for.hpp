#pragma once
/// Loops that can be cancelled and report their progress.
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "voxdag/core/parallel/parallel_for.hpp"
#include "voxdag/core/parallel/progress.hpp"

namespace voxdag {

/// Throws Cancelled if `progress`, which may be null, was cancelled.
inline void poll(const Progress* progress) {
  if (progress != nullptr) progress->throw_if_cancelled();
}

/// Calls poll() for one in 65,536 values of `i`. For serial loops over small items.
inline void poll_seldom(const Progress* progress, std::uint64_t i) {
  if ((i & 0xFFFF) == 0) poll(progress);
}

/// Calls body(i) for every i in [0, count), in any order, on the threads of the current TBB arena;
/// polls `progress`, which may be null, and reports to it as `stage` after every `grain` items.
/// Throws Cancelled, or the first exception of body.
template <class Body>
void polled_for(std::size_t count, std::size_t grain, Progress* progress, std::string_view stage,
                const Body& body) {
  std::atomic<std::size_t> done{0};
  parallel_for((count + grain - 1) / grain, [&](std::size_t part) {
    poll(progress);
    const std::size_t begin = part * grain, end = std::min(count, begin + grain);
    for (std::size_t i = begin; i != end; ++i) body(i);
    if (progress == nullptr) return;
    const std::size_t finished = done.fetch_add(end - begin, std::memory_order_relaxed);
    progress->report(stage,
                     static_cast<double>(finished + end - begin) / static_cast<double>(count),
                     finished + end - begin);
  });
}

}  // namespace voxdag
