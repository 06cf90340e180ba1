#pragma once
/// The kernels that cast rays from an array. All pointers are the device's.
#include <cuda_runtime_api.h>

#include "voxdag/core/grid.hpp"
#include "voxdag/cuda/device_voxels.hpp"
#include "voxdag/trace/hit.hpp"
#include "voxdag/trace/ray.hpp"
#include "voxdag/trace/scalar_caster.hpp"

namespace voxdag {

/// Sets hits[i] to the first voxel along rays[i], i < count.
void launch_closest_hits(const DeviceVoxels& dag, const Grid& grid, const Ray* rays, Hit* hits,
                         std::uint32_t count, cudaStream_t stream);

/// Sets hits[i] to 1 if rays[i] meets anything, else to 0, and cells[i] to the first cell that it
/// meets.
void launch_closest_cells(const DeviceVoxels& dag, const CastRay* rays, CellHit* cells,
                          std::uint8_t* hits, std::uint32_t count, cudaStream_t stream);
/// Sets hits[i] to 1 if rays[i] meets anything, else to 0.
void launch_any_hits(const DeviceVoxels& dag, const CastRay* rays, std::uint8_t* hits,
                     std::uint32_t count, cudaStream_t stream);

}  // namespace voxdag
