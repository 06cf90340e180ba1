#pragma once
/// The kernels of render_image. All pointers, those in `setup` included, are the device's.
#include <cuda_runtime_api.h>

#include "voxdag/cuda/device_voxels.hpp"
#include "voxdag/cuda/launch_plan.hpp"
#include "voxdag/cuda/resume_pixel.hpp"
#include "voxdag/render/post_filter.hpp"
#include "voxdag/render/render_setup.hpp"
#include "voxdag/render/view_sample.hpp"
#include "voxdag/stored/esvo/partial_esvo.hpp"

namespace voxdag {

/// Sets `starts` for the coarse beams [first, last), counted row by row.
void launch_beams(const DeviceVoxels& voxels, const RenderSetup& setup, std::uint32_t first,
                  std::uint32_t last, float* starts, cudaStream_t stream);

/// Sets the image's steps for the 8×8 pixels of the coarse beams [first, last).
void launch_steps(const DeviceVoxels& voxels, const RenderSetup& setup, std::uint32_t first,
                  std::uint32_t last, cudaStream_t stream);

/// Runs render_pixel() for all pixels of the range and adds the number of rays to `*rays`.
void launch_render(const DeviceVoxels& voxels, const RenderSetup& setup, const LaunchRange& range,
                   const ViewSample* view_samples, unsigned long long* rays, cudaStream_t stream);

/// Runs render_pixel() for the pixels of the blocks `blocks[range.first_block]` and on, at an ESVO
/// with missing blocks, and adds the number of rays to `*rays`. Where rays miss blocks, sets
/// `wanted[block]` to 1 for these blocks and `missed[i]` for the pixels of `blocks[i]`.
void launch_partial_render(const PartialEsvoView& voxels, const RenderSetup& setup,
                           const LaunchRange& range, const std::uint32_t* blocks,
                           std::uint8_t* wanted, std::uint8_t* missed, unsigned long long* rays,
                           cudaStream_t stream);

/// Runs resume_pixel() for all pixels of tiles[0] to tiles[count - 1], which are the pixels of
/// `logs` in this order, and adds the number of rays to `*rays`. Sets `missed[i]` if rays of
/// tiles[i] wait for blocks.
void launch_resume(const PartialEsvoView& voxels, const RenderSetup& setup, int sample,
                   const std::uint32_t* tiles, std::uint32_t count, const PixelLogs& logs,
                   std::uint8_t* wanted, std::uint8_t* missed, unsigned long long* rays,
                   cudaStream_t stream);

/// Sets `filtered` to filtered_color() of every pixel.
void launch_filter(const FilterInput& input, const FilterSample* samples, Vec3f* filtered,
                   cudaStream_t stream);

}  // namespace voxdag
