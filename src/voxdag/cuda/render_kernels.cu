#include "voxdag/cuda/beam_start.hpp"
#include "voxdag/cuda/launch.hpp"
#include "voxdag/cuda/render_kernel.hpp"
#include "voxdag/cuda/render_kernels.hpp"
#include "voxdag/cuda/with_nodes.hpp"
#include "voxdag/render/count_steps.hpp"
#include "voxdag/trace/partial_nodes.hpp"

namespace voxdag {
namespace {

constexpr std::uint32_t kBeamThreads = 64;
constexpr int kFilterSide = 16;  // pixels along a side of a block

/// Casts beams. At least sixteen blocks run per multiprocessor, so that 130 multiprocessors run all
/// beams of a picture of 1920×1080 at once.
template <class Nodes>
__global__ void __launch_bounds__(kBeamThreads, 16)
    beams_kernel(Nodes nodes, const __grid_constant__ RenderSetup setup, std::uint32_t first,
                 std::uint32_t last, float* starts) {
  const std::uint32_t i = 4 * first + blockIdx.x * kBeamThreads + threadIdx.x;
  if (i < 4 * last) set_beam_start(nodes, setup, i, starts);
}

template <class Nodes>
__global__ void __launch_bounds__(kBeamThreads)
    steps_kernel(Nodes nodes, const __grid_constant__ RenderSetup setup, std::uint32_t first,
                 std::uint32_t last) {
  const std::uint32_t i = first + blockIdx.x * kBeamThreads + threadIdx.x;
  if (i >= last) return;
  const auto across = static_cast<std::uint32_t>(beams_across(setup.camera.width) * kBeamPixels /
                                                 kCoarseBeamPixels);
  count_steps(nodes, setup, static_cast<int>(i % across) * kCoarseBeamPixels,
              static_cast<int>(i / across) * kCoarseBeamPixels);
}

__global__ void __launch_bounds__(kBlockPixels)
    partial_render_kernel(PartialEsvoView voxels, const __grid_constant__ RenderSetup setup,
                          const __grid_constant__ LaunchRange range, const std::uint32_t* blocks,
                          std::uint8_t* wanted, std::uint8_t* missed, unsigned long long* rays) {
  const std::uint32_t at = range.first_block + blockIdx.x;
  bool has_missed = false;
  const PartialNodes nodes(voxels, wanted, has_missed);
  const std::uint64_t count = render_pixel<TileScratch<1>>(nodes, ScalarCaster(nodes), setup, range,
                                                           nullptr, blocks[at], threadIdx.x);
  if (has_missed) missed[at] = 1;
  add_of_warp(rays, count);
}

__global__ void __launch_bounds__(kBlockPixels)
    resume_kernel(PartialEsvoView voxels, const __grid_constant__ RenderSetup setup, int sample,
                  const std::uint32_t* tiles, PixelLogs logs, std::uint8_t* wanted,
                  std::uint8_t* missed, unsigned long long* rays) {
  const std::uint32_t at = blockIdx.x * kBlockPixels + threadIdx.x;
  bool has_missed = false;
  const std::uint64_t count = resume_pixel(voxels, setup, sample, tiles[blockIdx.x], threadIdx.x,
                                           logs, at, wanted, has_missed);
  if (has_missed) missed[blockIdx.x] = 1;
  add_of_warp(rays, count);
}

__global__ void __launch_bounds__(kFilterSide* kFilterSide)
    filter_kernel(const __grid_constant__ FilterInput input, const FilterSample* samples,
                  Vec3f* filtered) {
  const int x = static_cast<int>(blockIdx.x) * kFilterSide + static_cast<int>(threadIdx.x);
  const int y = static_cast<int>(blockIdx.y) * kFilterSide + static_cast<int>(threadIdx.y);
  if (x >= input.width || y >= input.height) return;
  filtered[static_cast<std::size_t>(y) * static_cast<std::size_t>(input.width) +
           static_cast<std::size_t>(x)] = filtered_color(input, samples, x, y);
}

std::uint32_t beam_blocks(std::uint32_t threads) {
  return (threads + kBeamThreads - 1) / kBeamThreads;
}

}  // namespace

void launch_beams(const DeviceVoxels& voxels, const RenderSetup& setup, std::uint32_t first,
                  std::uint32_t last, float* starts, cudaStream_t stream) {
  with_beam_nodes(voxels, [&]<class Nodes>(const Nodes& nodes) {
    launch("casting beams", beams_kernel<Nodes>, beam_blocks(4 * (last - first)), kBeamThreads,
           stream, nodes, setup, first, last, starts);
  });
}

void launch_steps(const DeviceVoxels& voxels, const RenderSetup& setup, std::uint32_t first,
                  std::uint32_t last, cudaStream_t stream) {
  with_beam_nodes(voxels, [&]<class Nodes>(const Nodes& nodes) {
    launch("counting steps", steps_kernel<Nodes>, beam_blocks(last - first), kBeamThreads, stream,
           nodes, setup, first, last);
  });
}

void launch_render(const DeviceVoxels& voxels, const RenderSetup& setup, const LaunchRange& range,
                   const ViewSample* view_samples, unsigned long long* rays, cudaStream_t stream) {
  // Kernels of their own trace paths: they need more registers.
  if (setup.settings.bounces >= 0)
    return launch_paths(voxels, setup, range, view_samples, rays, stream);
  with_all_nodes(voxels, [&]<class BeamNodes, class Nodes>(const BeamNodes& beam_nodes,
                                                           const Nodes& nodes) {
    const auto caster = thread_caster(nodes);
    launch("rendering", render_kernel<TileScratch<1>, BeamNodes, std::decay_t<decltype(caster)>>,
           range.last_block - range.first_block, kBlockPixels, stream, beam_nodes, caster, setup,
           range, view_samples, rays);
  });
}

void launch_partial_render(const PartialEsvoView& voxels, const RenderSetup& setup,
                           const LaunchRange& range, const std::uint32_t* blocks,
                           std::uint8_t* wanted, std::uint8_t* missed, unsigned long long* rays,
                           cudaStream_t stream) {
  launch("rendering", partial_render_kernel, range.last_block - range.first_block, kBlockPixels,
         stream, voxels, setup, range, blocks, wanted, missed, rays);
}

void launch_resume(const PartialEsvoView& voxels, const RenderSetup& setup, int sample,
                   const std::uint32_t* tiles, std::uint32_t count, const PixelLogs& logs,
                   std::uint8_t* wanted, std::uint8_t* missed, unsigned long long* rays,
                   cudaStream_t stream) {
  launch("rendering", resume_kernel, count, kBlockPixels, stream, voxels, setup, sample, tiles,
         logs, wanted, missed, rays);
}

void launch_filter(const FilterInput& input, const FilterSample* samples, Vec3f* filtered,
                   cudaStream_t stream) {
  const auto blocks = [](int pixels) {
    return static_cast<unsigned>((pixels + kFilterSide - 1) / kFilterSide);
  };
  launch("filtering", filter_kernel, dim3(blocks(input.width), blocks(input.height)),
         dim3(kFilterSide, kFilterSide), stream, input, samples, filtered);
}

}  // namespace voxdag
