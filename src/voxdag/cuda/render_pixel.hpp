#pragma once
/// The work of one thread of the render kernel. Compiles for host and device: tests run it on the
/// host.
#include "voxdag/cuda/launch_plan.hpp"
#include "voxdag/render/esvo_view_samples.hpp"
#include "voxdag/render/render_tile.hpp"

namespace voxdag {

/// A block of threads renders 16×8 pixels. A warp renders 8×4 of them in Morton order, so that
/// threads of a warp cast rays that are close together.
inline constexpr int kBlockWidth = 16, kBlockHeight = 8;
inline constexpr std::uint32_t kBlockPixels = kBlockWidth * kBlockHeight;

VOXDAG_HD constexpr std::uint32_t blocks_across(int width) {
  return static_cast<std::uint32_t>((width + kBlockWidth - 1) / kBlockWidth);
}
VOXDAG_HD constexpr std::uint32_t block_count(int width, int height) {
  return blocks_across(width) *
         static_cast<std::uint32_t>((height + kBlockHeight - 1) / kBlockHeight);
}

/// Returns a block's part of the picture, clipped at its edges. Blocks are counted row by row.
VOXDAG_HD inline ViewTile block_tile(const Camera& camera, std::uint32_t block) {
  const std::uint32_t across = blocks_across(camera.width);
  ViewTile tile;
  tile.x = static_cast<int>(block % across) * kBlockWidth;
  tile.y = static_cast<int>(block / across) * kBlockHeight;
  tile.width = camera.width - tile.x < kBlockWidth ? camera.width - tile.x : kBlockWidth;
  tile.height = camera.height - tile.y < kBlockHeight ? camera.height - tile.y : kBlockHeight;
  return tile;
}

/// Returns the block of pixel (x,y).
VOXDAG_HD inline std::uint32_t block_at(const Camera& camera, int x, int y) {
  return static_cast<std::uint32_t>(y / kBlockHeight) * blocks_across(camera.width) +
         static_cast<std::uint32_t>(x / kBlockWidth);
}

/// Returns the x position of a thread's pixel in its block. The lowest five bits of the thread
/// index are x y x y x within the warp's 8×4 pixels, lowest first; the next ones are x, y and y of
/// the warp.
VOXDAG_HD constexpr int thread_x(std::uint32_t thread) {
  return static_cast<int>((thread & 1u) | (thread >> 1 & 2u) | (thread >> 2 & 4u) |
                          (thread >> 2 & 8u));
}
VOXDAG_HD constexpr int thread_y(std::uint32_t thread) {
  return static_cast<int>((thread >> 1 & 1u) | (thread >> 2 & 2u) | (thread >> 4 & 4u));
}

/// Renders the samples of a launch for a thread's pixel. Returns the number of rays. `view_samples`
/// has the view samples of all blocks of the launch, kBlockPixels for each, row by row; it is null
/// for a picture of voxels. With view samples a launch has one sample per pixel. `Scratch` is a
/// TileScratch for one pixel.
template <class Scratch, class Nodes, class Caster>
VOXDAG_HD inline std::uint64_t render_pixel(const Nodes& nodes, const Caster& caster,
                                            const RenderSetup& setup, const LaunchRange& range,
                                            const ViewSample* view_samples, std::uint32_t block,
                                            std::uint32_t thread) {
  const ViewTile part = block_tile(setup.camera, block);
  const int x = thread_x(thread), y = thread_y(thread);
  if (x >= part.width || y >= part.height) return 0;
  ViewTile tile;
  tile.x = part.x + x;
  tile.y = part.y + y;
  tile.width = tile.height = 1;
  const auto find = [&](const ViewTile& at, Scratch& scratch) {
    if (view_samples == nullptr) return trace_view_samples(nodes, caster, setup, at, scratch);
    const std::uint32_t first = (block - range.first_block) * kBlockPixels;
    scratch.samples[0] = view_samples[first + static_cast<std::uint32_t>(y * part.width + x)];
    return 1;
  };
  Scratch scratch;
  std::uint64_t rays = 0;
  for (int i = range.first_sample; i < range.last_sample; ++i) {
    set_sample(tile, i);
    rays += static_cast<std::uint64_t>(render_sample(nodes, caster, setup, tile, scratch, find));
  }
  return rays;
}

}  // namespace voxdag
