#pragma once
/// The kernels of trace_batch.
#include <cuda_runtime_api.h>

#include "voxdag/core/grid.hpp"
#include "voxdag/layout/svdag.hpp"
#include "voxdag/trace/hit.hpp"
#include "voxdag/trace/ray.hpp"

namespace voxdag {

/// hits[i] becomes the first voxel along rays[i], i < count. All pointers are the device's.
void launch_closest_hits(const SvdagView& dag, const Grid& grid, const Ray* rays, Hit* hits,
                         std::uint32_t count, cudaStream_t stream);

}  // namespace voxdag
