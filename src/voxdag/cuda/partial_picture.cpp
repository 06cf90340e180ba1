#include "voxdag/cuda/partial_picture.hpp"

#include <algorithm>
#include <cassert>

#include "voxdag/core/error.hpp"
#include "voxdag/cuda/device_frame.hpp"
#include "voxdag/cuda/device_voxels.hpp"
#include "voxdag/cuda/picture_launches.hpp"
#include "voxdag/cuda/render_kernels.hpp"

namespace voxdag {
namespace {

constexpr const char* kTiles = "the list of tiles";

}  // namespace

struct PartialPicture::State {
  State(const DeviceBlocks& blocks_in, const RenderPlan& plan, const RenderOptions& options,
        Work work_in)
      : blocks(blocks_in),
        frame(plan, options.beams, options.filter),
        has_beams(options.beams),
        work(work_in),
        tile_count(block_count(options.width, options.height)),
        tiles(make_device_buffer<std::uint32_t>(tile_count, kTiles)),
        missed(make_device_buffer<std::uint8_t>(tile_count, kTiles)),
        resumed(frame.setup()) {
    resumed.settings.beams = false;
  }

  std::uint64_t log_bytes_per_tile() const {
    return kBlockPixels *
           ((std::uint64_t{most_casts(resumed)} + 1) * sizeof(std::uint32_t) + sizeof(ViewSample));
  }
  /// Returns the logs of the pixels of `count` tiles. Allocates them, for `most_tiles` tiles, in
  /// the first call.
  PixelLogs logs(std::uint32_t count, std::uint32_t most_tiles) {
    if (log_known.size() == 0) {
      const char* what = "the log of the rays";
      const std::size_t most = std::size_t{most_tiles} * kBlockPixels;
      require_device_memory(most_tiles * log_bytes_per_tile(), what);
      log_states = make_device_buffer<std::uint32_t>(most * most_casts(resumed), what);
      log_view_samples = make_device_buffer<ViewSample>(most, what);
      log_known = make_device_buffer<std::uint32_t>(most, what);
    }
    return {count * kBlockPixels, log_known.data(), log_states.data(), log_view_samples.data()};
  }

  DeviceVoxels voxels() const {
    DeviceVoxels view;
    view.layout = DeviceLayout::kContours;
    view.esvo = blocks.view().octree;
    return view;
  }

  DeviceBlocks blocks;
  DeviceFrame frame;
  bool has_beams;
  Work work;
  std::uint32_t tile_count;
  DeviceBuffer<std::uint32_t> tiles;  ///< Those of a call of render().
  DeviceBuffer<std::uint8_t> missed;  ///< For each of them, whether its rays missed blocks.
  RenderSetup resumed;                ///< The setup without beams to lights.
  DeviceBuffer<std::uint32_t> log_known, log_states;
  DeviceBuffer<ViewSample> log_view_samples;
  CudaStream stream;  // last, so that it is destroyed before the memory that it uses
};

PartialPicture::PartialPicture(const DeviceBlocks& blocks, const RenderPlan& plan,
                               const RenderOptions& options, Work work) {
  if (options.bounces) throw Error("a device cannot trace paths in an ESVO that is streamed");
  blocks.make_current();
  state_ = std::make_shared<State>(blocks, plan, options, work);
}

std::uint32_t PartialPicture::tile_count() const { return state_->tile_count; }

ViewTile PartialPicture::tile(std::uint32_t index) const {
  return block_tile(state_->frame.setup().camera, index);
}

void PartialPicture::cast_beams() const {
  const State& state = *state_;
  if (!state.has_beams) return;
  state.blocks.make_current();
  for_beams(state.frame.setup().camera, state.stream, state.work,
            [&](std::uint32_t first, std::uint32_t last) {
              launch_beams(state.voxels(), state.frame.setup(), first, last,
                           state.frame.beam_starts(), state.stream.get());
            });
}

std::vector<std::uint32_t> PartialPicture::render(std::span<const std::uint32_t> tiles,
                                                  const char* stage) const {
  const State& state = *state_;
  const RenderSetup& setup = state.frame.setup();
  state.blocks.make_current();
  std::vector<std::uint8_t> missed(tiles.size());
  copy_to_device(state.tiles.data(), tiles.data(), tiles.size_bytes());
  copy_to_device(state.missed.data(), missed.data(), missed.size());
  LaunchPlan plan = plan_launches(setup, static_cast<std::uint32_t>(tiles.size()), kMaxBlocks,
                                  setup.settings.samples_per_pixel);
  const CudaEvent begin, end;
  while (const auto range = plan.next()) {
    state.work.poll();
    begin.record(state.stream);
    launch_partial_render(state.blocks.view(), setup, *range, state.tiles.data(),
                          state.blocks.wanted(), state.missed.data(), state.frame.rays(),
                          state.stream.get());
    end.record(state.stream);
    state.stream.wait("rendering");
    plan.measured(*range, seconds_between(begin, end));
    if (stage != nullptr) state.work.report(stage, plan.fraction());
  }
  copy_to_host(missed.data(), state.missed.data(), missed.size());
  std::vector<std::uint32_t> left;
  for (std::size_t i = 0; i < tiles.size(); ++i)
    if (missed[i] != 0) left.push_back(tiles[i]);
  return left;
}

std::uint32_t PartialPicture::most_resumed() const {
  constexpr std::uint64_t kMaxBytes = std::uint64_t{64} << 20;
  const std::uint64_t tiles = kMaxBytes / state_->log_bytes_per_tile();
  return static_cast<std::uint32_t>(std::clamp<std::uint64_t>(tiles, 1, state_->tile_count));
}

std::size_t PartialPicture::resume(std::span<const std::uint32_t> tiles, int sample,
                                   bool begins) const {
  State& state = *state_;
  assert(tiles.size() <= most_resumed());
  state.work.poll();
  state.blocks.make_current();
  const auto count = static_cast<std::uint32_t>(tiles.size());
  const PixelLogs logs = state.logs(count, most_resumed());
  if (begins) {
    const std::vector<std::uint32_t> none(logs.pixels);
    copy_to_device(logs.known, none.data(), none.size() * sizeof(std::uint32_t));
    copy_to_device(state.tiles.data(), tiles.data(), tiles.size_bytes());
  }
  std::vector<std::uint8_t> missed(tiles.size());
  copy_to_device(state.missed.data(), missed.data(), missed.size());
  launch_resume(state.blocks.view(), state.resumed, sample, state.tiles.data(), count, logs,
                state.blocks.wanted(), state.missed.data(), state.frame.rays(), state.stream.get());
  state.stream.wait("rendering");
  copy_to_host(missed.data(), state.missed.data(), missed.size());
  return static_cast<std::size_t>(std::count(missed.begin(), missed.end(), std::uint8_t{1}));
}

void PartialPicture::count_steps() const {
  const State& state = *state_;
  state.blocks.make_current();
  for_beams(state.frame.setup().camera, state.stream, state.work,
            [&](std::uint32_t first, std::uint32_t last) {
              launch_steps(state.voxels(), state.frame.setup(), first, last, state.stream.get());
            });
}

void PartialPicture::copy_to(RenderedImage& image) const {
  state_->blocks.make_current();
  state_->frame.copy_to(image, false);
}

}  // namespace voxdag
