#pragma once
/// The kernels of render_image. All pointers, those in `setup` included, are the device's.
#include <cuda_runtime_api.h>

#include "voxdag/cuda/device_voxels.hpp"
#include "voxdag/cuda/launch_plan.hpp"
#include "voxdag/cuda/render_pixel.hpp"
#include "voxdag/render/post_filter.hpp"
#include "voxdag/render/render_setup.hpp"
#include "voxdag/render/view_sample.hpp"
#include "voxdag/stored/esvo/partial_esvo.hpp"
#include "voxdag/trace/resumed_rays.hpp"

namespace voxdag {

/// Returns the most casts of one sample of a pixel, without beams to lights.
VOXDAG_HD inline std::uint32_t most_casts(const RenderSetup& setup) {
  int casts = 1 + kMaxStartCasts + setup.settings.occlusion_samples;
  for (int i = 0; i < setup.light_count; ++i)
    casts += setup.lights[i].is_extended() ? setup.settings.light_samples : 1;
  return static_cast<std::uint32_t>(casts);
}

/// The logs of the pixels that are rendered together. Owns nothing.
struct PixelLogs {
  static constexpr std::uint32_t kDone = ~0u;

  std::uint32_t pixels = 0;            ///< Number of them.
  std::uint32_t* known = nullptr;      ///< Per pixel: RayLog::known(), or kDone if it is finished.
  std::uint32_t* states = nullptr;     ///< most_casts() rows of one word per pixel.
  ViewSample* view_samples = nullptr;  ///< Per pixel, once its primary ray has ended.
};

/// Continues sample `sample` of a thread's pixel, pixel `at` of the logs. Adds the sample to the
/// picture once it is finished, and then returns the number of its rays, else 0. `setup` must be
/// without beams to lights, and a pixel's samples must come in order. Sets `has_missed` if rays
/// wait for blocks, and wanted[block] for these blocks.
VOXDAG_HD inline std::uint64_t resume_pixel(const PartialEsvoView& voxels, const RenderSetup& setup,
                                            int sample, std::uint32_t block, std::uint32_t thread,
                                            const PixelLogs& logs, std::uint32_t at,
                                            std::uint8_t* wanted, bool& has_missed) {
  const ViewTile part = block_tile(setup.camera, block);
  const int x = thread_x(thread), y = thread_y(thread);
  if (x >= part.width || y >= part.height || logs.known[at] == PixelLogs::kDone) return 0;
  ViewTile tile;
  tile.x = part.x + x;
  tile.y = part.y + y;
  tile.width = tile.height = 1;
  set_sample(tile, sample);

  RayLog log(logs.states + at, logs.pixels, logs.known[at], most_casts(setup));
  const ResumedNodes nodes(voxels, wanted, log);
  const ResumedCaster caster(nodes);
  const auto find = [&](const ViewTile& pixel, TileScratch<1>& scratch) {
    if (log.skip_ended()) {
      scratch.samples[0] = logs.view_samples[at];
      return 1;
    }
    const int rays = trace_view_samples(nodes, caster, setup, pixel, scratch);
    if (!log.has_missed()) logs.view_samples[at] = scratch.samples[0];
    return rays;
  };
  // An unfinished sample must not count: the picture's sums are put back.
  const ImageBuffers& image = setup.image;
  const std::size_t place =
      static_cast<std::size_t>(tile.y) * static_cast<std::size_t>(setup.camera.width) +
      static_cast<std::size_t>(tile.x);
  const Vec3f radiance = image.radiance[place];
  const float coverage = image.coverage[place];
  const float occlusion = image.occlusion != nullptr ? image.occlusion[place] : 0;
  const float shadow = image.shadow != nullptr ? image.shadow[place] : 0;
  TileScratch<1> scratch;
  const int rays = render_sample(nodes, caster, setup, tile, scratch, find);
  has_missed = log.has_missed();
  logs.known[at] = has_missed ? log.known() : PixelLogs::kDone;
  if (!has_missed) return static_cast<std::uint64_t>(rays);
  image.radiance[place] = radiance;
  image.coverage[place] = coverage;
  if (image.occlusion != nullptr) image.occlusion[place] = occlusion;
  if (image.shadow != nullptr) image.shadow[place] = shadow;
  return 0;
}

/// Sets `starts` for the coarse beams [first, last), counted row by row.
void launch_beams(const DeviceVoxels& voxels, const RenderSetup& setup, std::uint32_t first,
                  std::uint32_t last, float* starts, cudaStream_t stream);

/// Sets the image's steps for the 8×8 pixels of the coarse beams [first, last).
void launch_steps(const DeviceVoxels& voxels, const RenderSetup& setup, std::uint32_t first,
                  std::uint32_t last, cudaStream_t stream);

/// Does what launch_render() does for a picture with paths.
void launch_paths(const DeviceVoxels& voxels, const RenderSetup& setup, const LaunchRange& range,
                  const ViewSample* view_samples, unsigned long long* rays, cudaStream_t stream);

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
