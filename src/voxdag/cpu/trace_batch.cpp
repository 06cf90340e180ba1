#include "voxdag/cpu/trace_batch.hpp"

#include <algorithm>
#include <atomic>
#include <cassert>

#include "voxdag/core/parallel/parallel_for.hpp"

namespace voxdag {

namespace {

constexpr std::size_t kBlock = 4096;

template <class Caster>
void trace_block(const Caster& caster, const Grid& grid, std::span<const Ray> rays,
                 std::span<Hit> hits) {
  caster.closest(
      static_cast<int>(rays.size()),
      [&](int i) {
        return CastRay{make_grid_ray(grid, rays[i]), {}};
      },
      [&](int i, const GridRay& ray, const auto& cell, bool is_hit) {
        const auto at = static_cast<std::size_t>(i);
        hits[at] = is_hit ? to_hit(ray, cell, grid.levels, rays[at].t_min, rays[at].t_max) : Hit{};
      });
}

/// Casts all rays in blocks.
template <class Caster>
void trace_all(const Caster& caster, const Grid& grid, std::span<const Ray> rays,
               std::span<Hit> hits, Work work) {
  const std::size_t blocks = (rays.size() + kBlock - 1) / kBlock;
  std::atomic<std::size_t> done{0};
  parallel_for(blocks, [&](std::size_t block) {
    if (work.cancelled()) return;
    const std::size_t begin = block * kBlock, size = std::min(kBlock, rays.size() - begin);
    trace_block(caster, grid, rays.subspan(begin, size), hits.subspan(begin, size));
    const std::size_t so_far = done.fetch_add(size) + size;
    work.report_done("trace", so_far, rays.size());
  });
  work.poll();
}

}  // namespace

void trace_batch(const CpuScene& scene, const Grid& grid, std::span<const Ray> rays,
                 std::span<Hit> hits, Work work) {
  assert(rays.size() == hits.size() && grid.levels == scene.voxels().levels());
  scene.visit([&](const auto&, const auto& caster) { trace_all(caster, grid, rays, hits, work); });
}

void trace_batch(const InPlaceDag& dag, const Grid& grid, std::span<const Ray> rays,
                 std::span<Hit> hits, Work work) {
  assert(rays.size() == hits.size() && grid.levels == dag.levels());
  trace_all(PacketCaster<InPlaceDag>(dag), grid, rays, hits, work);
}

}  // namespace voxdag
