#pragma once
/// Loops that can be cancelled and report their progress.
#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "voxdag/core/parallel/parallel_for.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

/// Calls body(i) for every i in [0, count), in any order, on several threads; polls `work` and
/// reports to it as `stage` after every `grain` items. Throws Cancelled, or the first exception of
/// body.
template <class Body>
void polled_for(std::size_t count, std::size_t grain, Work work, std::string_view stage,
                const Body& body) {
  std::atomic<std::size_t> done{0};
  parallel_for((count + grain - 1) / grain, [&](std::size_t part) {
    work.poll();
    const std::size_t begin = part * grain, end = std::min(count, begin + grain);
    for (std::size_t i = begin; i != end; ++i) body(i);
    if (work.progress == nullptr) return;
    const std::size_t finished = done.fetch_add(end - begin, std::memory_order_relaxed);
    work.report_done(stage, finished + end - begin, count);
  });
}

}  // namespace voxdag
