#include <nanovdb/NanoVDB.h>
#include <nanovdb/util/HDDA.h>
#include <nanovdb/util/Ray.h>

#include "lab/rivals/nanovdb_kernel.hpp"
#include "voxdag/cuda/launch.hpp"

namespace voxdag {
namespace {

using MaskGrid = nanovdb::NanoGrid<nanovdb::ValueMask>;
constexpr std::uint32_t kThreads = 128;

/// Walks as nanovdb::ZeroCrossing does, and ends at the first active voxel.
__device__ bool meets_active_voxel(const MaskGrid& grid, const NanoVdbRay& from) {
  using nanovdb::Coord, nanovdb::Vec3f;
  nanovdb::Ray<float> ray(Vec3f(from.origin[0], from.origin[1], from.origin[2]),
                          Vec3f(from.direction[0], from.direction[1], from.direction[2]),
                          from.t_min, from.t_max);
  auto accessor = grid.getAccessor();
  if (!ray.clip(accessor.root().bbox())) return false;
  Coord at = nanovdb::RoundDown<Coord>(ray.start());
  nanovdb::HDDA<nanovdb::Ray<float>, Coord> hdda(ray, static_cast<int>(accessor.getDim(at, ray)));
  const float past_face = 1e-3f / ray.dir().length();  // a thousandth of a voxel, in units of t
  while (hdda.dim() > 1 || !accessor.isActive(at)) {
    const bool among_voxels = hdda.dim() == 1;
    if (!hdda.step()) return false;
    at = among_voxels ? hdda.voxel() : nanovdb::RoundDown<Coord>(ray(hdda.time() + past_face));
    hdda.update(ray, static_cast<int>(accessor.getDim(at, ray)));
  }
  return true;
}

__global__ void __launch_bounds__(kThreads)
    nanovdb_hits_kernel(const MaskGrid* grid, const NanoVdbRay* rays, std::uint8_t* hits,
                        std::uint32_t count) {
  const std::uint32_t i = blockIdx.x * kThreads + threadIdx.x;
  if (i < count) hits[i] = meets_active_voxel(*grid, rays[i]) ? 1 : 0;
}

}  // namespace

void launch_nanovdb_hits(const void* grid, const NanoVdbRay* rays, std::uint8_t* hits,
                         std::uint32_t count, cudaStream_t stream) {
  launch("casting rays", nanovdb_hits_kernel, (count + kThreads - 1) / kThreads, kThreads, stream,
         static_cast<const MaskGrid*>(grid), rays, hits, count);
}

}  // namespace voxdag
