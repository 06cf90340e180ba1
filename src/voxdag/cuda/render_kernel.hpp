#pragma once
/// The kernel that renders pixels, for .cu files that compile it for different effects.
#include <cuda_runtime.h>

#include "voxdag/cuda/render_pixel.hpp"

namespace voxdag {

/// Adds the counts of all threads of the warp to `*sum`.
__device__ inline void add_of_warp(unsigned long long* sum, unsigned long long count) {
  for (int step = 16; step > 0; step /= 2) count += __shfl_down_sync(~0u, count, step);
  if (threadIdx.x % 32 == 0) atomicAdd(sum, count);
}

/// Runs render_pixel<Scratch>() for all pixels of the range and adds the number of rays to `*rays`.
template <class Scratch, class Nodes, class Caster>
__global__ void __launch_bounds__(kBlockPixels)
    render_kernel(Nodes nodes, Caster caster, const __grid_constant__ RenderSetup setup,
                  const __grid_constant__ LaunchRange range, const ViewSample* view_samples,
                  unsigned long long* rays) {
  add_of_warp(rays, render_pixel<Scratch>(nodes, caster, setup, range, view_samples,
                                          range.first_block + blockIdx.x, threadIdx.x));
}

}  // namespace voxdag
