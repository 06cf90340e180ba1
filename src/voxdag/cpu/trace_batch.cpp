#include "voxdag/cpu/trace_batch.hpp"

#include <algorithm>
#include <atomic>
#include <cassert>

#include "voxdag/parallel/parallel_for.hpp"
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {

void trace_batch(const SvdagView& dag, const Grid& grid, std::span<const Ray> rays,
                 std::span<Hit> hits, Progress* progress) {
  assert(rays.size() == hits.size() && grid.levels == dag.levels);
  constexpr std::size_t kBlock = 4096;
  const std::size_t blocks = (rays.size() + kBlock - 1) / kBlock;
  const SvdagNodes nodes(dag);
  std::atomic<std::size_t> done{0};
  parallel_for(blocks, [&](std::size_t block) {
    if (progress != nullptr && progress->cancelled()) return;
    const std::size_t end = std::min((block + 1) * kBlock, rays.size());
    for (std::size_t i = block * kBlock; i < end; ++i) hits[i] = closest_hit(nodes, grid, rays[i]);
    const std::size_t so_far = done.fetch_add(end - block * kBlock) + end - block * kBlock;
    if (progress != nullptr)
      progress->report("trace", static_cast<double>(so_far) / static_cast<double>(rays.size()),
                       so_far);
  });
  if (progress != nullptr) progress->throw_if_cancelled();
}

}  // namespace voxdag
