#pragma once
/// The kernel that casts rays at a NanoVDB mask grid.
#include <cuda_runtime_api.h>

#include <cstdint>

namespace voxdag::lab {

/// A ray in units of voxels; voxel (i,j,k) is the cube with its lower corner at (i,j,k).
struct NanoVdbRay {
  float origin[3], direction[3];
  float t_min, t_max;
};

/// Queues the casts of `count` rays, at least one. `grid` is a NanoVDB grid of ValueMask. All
/// arrays are the device's. Sets 1 in `hits` for each ray that meets an active voxel, else 0.
void launch_nanovdb_hits(const void* grid, const NanoVdbRay* rays, std::uint8_t* hits,
                         std::uint32_t count, cudaStream_t stream);

}  // namespace voxdag::lab
