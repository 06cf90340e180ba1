#include "voxdag/cuda/launch.hpp"
#include "voxdag/cuda/trace_kernels.hpp"
#include "voxdag/cuda/with_nodes.hpp"

namespace voxdag {
namespace {

constexpr std::uint32_t kThreads = 128;
constexpr int kRaysPerThread = 16;
constexpr const char* kDoing = "casting rays";

template <class Nodes>
__global__ void __launch_bounds__(kThreads)
    closest_hits_kernel(Nodes nodes, Grid grid, const Ray* rays, Hit* hits, std::uint32_t count) {
  const std::uint32_t i = blockIdx.x * kThreads + threadIdx.x;
  if (i < count) hits[i] = closest_hit(nodes, grid, rays[i]);
}

template <class Nodes>
__global__ void __launch_bounds__(kThreads)
    closest_cells_kernel(Nodes nodes, const CastRay* rays, CellHit* cells, std::uint8_t* hits,
                         std::uint32_t count) {
  const std::uint32_t i = blockIdx.x * kThreads + threadIdx.x;
  if (i >= count) return;
  const CastRay ray = rays[i];
  CellHit cell;
  hits[i] = cast(nodes, ray.ray, ray.stop, cell) ? 1 : 0;
  cells[i] = cell;
}

template <class Nodes>
__global__ void __launch_bounds__(kThreads)
    any_hits_kernel(Nodes nodes, const CastRay* rays, std::uint8_t* hits, std::uint32_t count) {
  const std::uint32_t i = blockIdx.x * kThreads + threadIdx.x;
  if (i >= count) return;
  const CastRay ray = rays[i];
  CellHit cell;
  hits[i] = cast(nodes, ray.ray, ray.stop, cell) ? 1 : 0;
}

/// Each thread casts kRaysPerThread rays. Rays that are cast together are consecutive.
template <class Caster>
__global__ void __launch_bounds__(kThreads)
    any_hits_of_threads_kernel(Caster caster, const CastRay* rays, std::uint8_t* hits,
                               std::uint32_t count) {
  constexpr std::uint32_t kWarp = 32;
  const std::uint32_t warp = (blockIdx.x * kThreads + threadIdx.x) / kWarp;
  const std::uint64_t first = std::uint64_t{warp} * kWarp * kRaysPerThread + threadIdx.x % kWarp;
  const auto at = [&](int i) { return first + static_cast<std::uint64_t>(i) * kWarp; };
  caster.any(
      kRaysPerThread, [&](int i) { return at(i) < count ? rays[at(i)] : CastRay{}; },
      [&](int i, bool is_hit) {
        if (at(i) < count) hits[at(i)] = is_hit ? 1 : 0;
      });
}

std::uint32_t blocks_of(std::uint32_t count) { return (count + kThreads - 1) / kThreads; }

}  // namespace

void launch_closest_hits(const DeviceVoxels& dag, const Grid& grid, const Ray* rays, Hit* hits,
                         std::uint32_t count, cudaStream_t stream) {
  if (count == 0) return;
  with_nodes(dag, [&]<class Nodes>(const Nodes& nodes) {
    launch(kDoing, closest_hits_kernel<Nodes>, blocks_of(count), kThreads, stream, nodes, grid,
           rays, hits, count);
  });
}

void launch_closest_cells(const DeviceVoxels& dag, const CastRay* rays, CellHit* cells,
                          std::uint8_t* hits, std::uint32_t count, cudaStream_t stream) {
  if (count == 0) return;
  with_nodes(dag, [&]<class Nodes>(const Nodes& nodes) {
    launch(kDoing, closest_cells_kernel<Nodes>, blocks_of(count), kThreads, stream, nodes, rays,
           cells, hits, count);
  });
}

void launch_any_hits(const DeviceVoxels& dag, const CastRay* rays, std::uint8_t* hits,
                     std::uint32_t count, cudaStream_t stream) {
  if (count == 0) return;
  with_nodes(dag, [&]<class Nodes>(const Nodes& nodes) {
    if constexpr (std::is_same_v<Nodes, TopNodes>)
      launch(kDoing, any_hits_of_threads_kernel<RefillCaster<>>,
             blocks_of((count + kRaysPerThread - 1) / kRaysPerThread), kThreads, stream,
             RefillCaster<>(nodes), rays, hits, count);
    else
      launch(kDoing, any_hits_kernel<Nodes>, blocks_of(count), kThreads, stream, nodes, rays, hits,
             count);
  });
}

}  // namespace voxdag
