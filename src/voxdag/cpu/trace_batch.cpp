#include "voxdag/cpu/trace_batch.hpp"

#include <algorithm>
#include <atomic>
#include <cassert>

#include "voxdag/cpu/packet_caster.hpp"
#include "voxdag/parallel/parallel_for.hpp"

namespace voxdag {

void trace_batch(const SvdagView& dag, const Grid& grid, std::span<const Ray> rays,
                 std::span<Hit> hits, Progress* progress) {
  assert(rays.size() == hits.size() && grid.levels == dag.levels);
  constexpr std::size_t kBlock = 4096;
  const std::size_t blocks = (rays.size() + kBlock - 1) / kBlock;
  const PacketCaster caster{SvdagNodes(dag)};
  std::atomic<std::size_t> done{0};
  parallel_for(blocks, [&](std::size_t block) {
    if (progress != nullptr && progress->cancelled()) return;
    const std::size_t end = std::min((block + 1) * kBlock, rays.size());
    const std::span<const Ray> some = rays.subspan(block * kBlock, end - block * kBlock);
    caster.closest(
        static_cast<int>(some.size()),
        [&](int i) {
          return CastRay{make_grid_ray(grid, some[static_cast<std::size_t>(i)]), {}};
        },
        [&](int i, const GridRay& ray, const CellHit& cell, bool is_hit) {
          const std::size_t at = static_cast<std::size_t>(i);
          const Ray& world = some[at];
          hits[block * kBlock + at] =
              is_hit ? to_hit(ray, cell, dag.levels, world.t_min, world.t_max) : Hit{};
        });
    const std::size_t so_far = done.fetch_add(end - block * kBlock) + end - block * kBlock;
    if (progress != nullptr)
      progress->report("trace", static_cast<double>(so_far) / static_cast<double>(rays.size()),
                       so_far);
  });
  if (progress != nullptr) progress->throw_if_cancelled();
}

}  // namespace voxdag
