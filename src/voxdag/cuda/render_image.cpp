#include "voxdag/cuda/render_image.hpp"

#include <cassert>

#include "voxdag/core/parallel/parallel_for.hpp"
#include "voxdag/cuda/device_frame.hpp"
#include "voxdag/cuda/picture_launches.hpp"
#include "voxdag/cuda/render_kernels.hpp"
#include "voxdag/render/source_view_samples.hpp"

namespace voxdag {
namespace {

/// The number of blocks for which the host finds view samples at a time.
constexpr std::uint32_t kSourceBlocks = 4096;
/// A buffer for view samples. Two of them alternate: the device reads one while the host fills the
/// other.
struct SourceSamples {
  PinnedBuffer<ViewSample> host;
  DeviceBuffer<ViewSample> device;
};

/// Finds the view samples of a launch, one for each pixel.
void fill(SourceSamples& samples, const ViewSource& source, const RenderSetup& setup,
          const LaunchRange& range) {
  parallel_for(std::size_t{range.last_block} - range.first_block, [&](std::size_t i) {
    ViewTile tile = block_tile(setup.camera, range.first_block + static_cast<std::uint32_t>(i));
    set_sample(tile, range.first_sample);
    find_source_samples(
        source, setup, tile,
        {samples.host.data() + i * kBlockPixels, static_cast<std::size_t>(tile.pixels())});
  });
}

void render_pixels(const DeviceVoxels& dag, const DeviceFrame& frame, Work work,
                   const ViewSource* source) {
  const RenderSetup& setup = frame.setup();
  const bool has_source = source != nullptr;
  LaunchPlan plan = plan_launches(setup, block_count(setup.camera.width, setup.camera.height),
                                  has_source ? kSourceBlocks : kMaxBlocks,
                                  has_source ? 1 : setup.settings.samples_per_pixel);
  SourceSamples samples[2];
  for (SourceSamples& part : samples) {
    if (!has_source) break;
    part.host = make_pinned_buffer<ViewSample>(kSourceBlocks * kBlockPixels, "view samples");
    part.device = make_device_buffer<ViewSample>(kSourceBlocks * kBlockPixels, "view samples");
  }
  const CudaEvent begin, end;
  const CudaStream stream;  // last, so that it is destroyed before the memory that it uses
  int turn = 0;
  auto range = plan.next();
  if (has_source && range) fill(samples[turn], *source, setup, *range);
  while (range) {
    work.poll();
    begin.record(stream);
    if (has_source)
      check_cuda(cudaMemcpyAsync(
                     samples[turn].device.data(), samples[turn].host.data(),
                     (range->last_block - range->first_block) * kBlockPixels * sizeof(ViewSample),
                     cudaMemcpyHostToDevice, stream.get()),
                 "copying view samples to the device");
    launch_render(dag, setup, *range, samples[turn].device.data(), frame.rays(), stream.get());
    end.record(stream);
    const double fraction = plan.fraction();
    const auto next = plan.next();
    turn ^= 1;
    if (has_source && next) fill(samples[turn], *source, setup, *next);
    stream.wait("rendering");
    plan.measured(*range, seconds_between(begin, end));
    work.report("render", fraction);
    range = next;
  }
}

}  // namespace

RenderedImage render_image(const DeviceScene& scene, const Grid& grid, const RenderOptions& options,
                           Work work, const ViewSource* source) {
  assert(grid.levels == scene.host().levels());
  scene.make_current();
  RenderPlan plan(scene.host(), grid, options);
  // Without beams for primary rays: on an H100 they take longer than they save.
  const DeviceFrame frame(plan, false, options.filter);
  const RenderSetup& setup = frame.setup();
  const CudaStream stream;
  render_pixels(scene.view(), frame, work, source);
  if (options.with_steps)
    for_beams(setup.camera, stream, work, [&](std::uint32_t first, std::uint32_t last) {
      launch_steps(scene.view(), setup, first, last, stream.get());
    });
  const bool is_filtered = options.filter != FilterKind::kNone && source == nullptr;
  if (is_filtered) {
    launch_filter(frame.filter_input(), frame.filter_samples(), frame.filtered(), stream.get());
    stream.wait("filtering");
  }
  frame.copy_to(plan.image(), is_filtered);
  return plan.finish();
}

}  // namespace voxdag
