#pragma once
/// Renders the tiles of a picture on the CPU's threads.
#include <algorithm>
#include <atomic>
#include <memory>
#include <span>
#include <vector>

#include "voxdag/core/morton.hpp"
#include "voxdag/core/parallel/parallel_for.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/cpu/beam_starts.hpp"
#include "voxdag/cpu/layer_cache.hpp"
#include "voxdag/render/count_steps.hpp"
#include "voxdag/render/esvo_view_samples.hpp"
#include "voxdag/render/render_tile.hpp"
#include "voxdag/render/source_view_samples.hpp"

namespace voxdag {

/// Returns tiles that cover the picture, in Morton order: a thread's next tile is near its last.
inline std::vector<ViewTile> make_tiles(int width, int height, int size) {
  const int across = (width + size - 1) / size, down = (height + size - 1) / size;
  std::vector<ViewTile> tiles;
  tiles.reserve(static_cast<std::size_t>(across) * static_cast<std::size_t>(down));
  for (int y = 0; y < down; ++y)
    for (int x = 0; x < across; ++x) {
      ViewTile tile;
      tile.x = x * size;
      tile.y = y * size;
      tile.width = std::min(size, width - tile.x);
      tile.height = std::min(size, height - tile.y);
      tiles.push_back(tile);
    }
  const auto code = [size](const ViewTile& tile) {
    return morton_encode({tile.x / size, tile.y / size, 0});
  };
  std::sort(tiles.begin(), tiles.end(),
            [&](const ViewTile& a, const ViewTile& b) { return code(a) < code(b); });
  return tiles;
}

/// Calls body(x, y) for the top left pixel of each block of 8×8 pixels of the picture.
template <class Body>
void for_each_block(const Camera& camera, const Body& body) {
  const int rows = (camera.height + kCoarseBeamPixels - 1) / kCoarseBeamPixels;
  parallel_for(static_cast<std::size_t>(rows), [&](std::size_t row) {
    for (int x = 0; x < camera.width; x += kCoarseBeamPixels)
      body(x, static_cast<int>(row) * kCoarseBeamPixels);
  });
}

/// Renders the picture of a setup. Sets only two fields of its copy of the setup: the starts of
/// primary rays, and whether lights have beams.
template <class Nodes, class Caster>
class TileRenderer {
 public:
  static constexpr int kMaxTileSize = 32;
  /// Beams to lights run one at a time, shadow rays in packets. With fewer rays than this for each
  /// beam, the beams cost more than they save (`bench trace --light-sizes` measures it).
  static constexpr int kMinRaysPerLightBeam = 64;

  /// If `source` is null, surface points come from the voxels.
  TileRenderer(const Nodes& nodes, const Caster& caster, const RenderSetup& setup, bool beams,
               const ViewSource* source)
      : nodes_(nodes), caster_(caster), setup_(setup), source_(source) {
    setup_.settings.beams =
        setup.settings.beams && setup.settings.light_samples >= kMinRaysPerLightBeam;
    if (!beams || source != nullptr) return;
    find_beam_starts(nodes_, setup_, beam_starts_);
    setup_.beam_starts = beam_starts_.data();
  }
  TileRenderer(const TileRenderer&) = delete;
  TileRenderer& operator=(const TileRenderer&) = delete;

  /// Returns the number of rays. Throws Cancelled.
  std::uint64_t render(std::span<const ViewTile> tiles, Work work) const {
    std::atomic<std::uint64_t> rays{0};
    std::atomic<std::size_t> done{0};
    parallel_for(tiles.size(), [&](std::size_t at) {
      if (work.cancelled()) return;
      const std::uint64_t tile_rays = render_one(nodes_, caster_, tiles[at]);
      const std::uint64_t rays_so_far = rays.fetch_add(tile_rays) + tile_rays;
      const std::size_t tiles_so_far = done.fetch_add(1) + 1;
      work.report("render", static_cast<double>(tiles_so_far) / static_cast<double>(tiles.size()),
                  rays_so_far);
    });
    work.poll();
    return rays;
  }

  /// Renders a tile in this thread, with any caster for these voxels. Returns the number of rays.
  template <class TileNodes, class TileCaster>
  std::uint64_t render_one(const TileNodes& nodes, const TileCaster& caster,
                           const ViewTile& tile) const {
    const auto scratch = std::make_unique<Scratch>();
    const auto find = [&](const ViewTile& sample_tile, Scratch& tile_scratch) {
      return find_samples(nodes, caster, sample_tile, tile_scratch);
    };
    return static_cast<std::uint64_t>(render_tile(nodes, caster, setup_, tile, *scratch, find));
  }

  /// Sets the picture's steps of primary rays. Casts rays and beams one at a time.
  void count() const {
    const Camera& camera = setup_.camera;
    RenderSetup setup = setup_;
    std::vector<float> starts(beam_starts_.size());
    if (!starts.empty()) setup.beam_starts = starts.data();
    for_each_block(camera, [&](int x, int y) {
      if (!starts.empty()) set_beam_starts(nodes_, setup_, x, y, starts.data());
      count_steps(nodes_, setup, x, y);
    });
  }

 private:
  static constexpr int kMaxPixels = kMaxTileSize * kMaxTileSize;
  using Scratch = TileScratch<kMaxPixels, PathScratch<kMaxPixels>, LayerCache>;

  template <class TileNodes, class TileCaster>
  int find_samples(const TileNodes& nodes, const TileCaster& caster, const ViewTile& tile,
                   Scratch& scratch) const {
    if (source_ == nullptr) return trace_view_samples(nodes, caster, setup_, tile, scratch);
    const auto pixels = static_cast<std::size_t>(tile.pixels());
    std::vector<ViewSample> rows(pixels);
    find_source_samples(*source_, setup_, tile, rows);
    for (int pixel = 0; pixel < tile.pixels(); ++pixel)
      scratch.samples[pixel] =
          rows[static_cast<std::size_t>(tile.row(pixel)) * static_cast<std::size_t>(tile.width) +
               static_cast<std::size_t>(tile.column(pixel))];
    return static_cast<int>(pixels);
  }

  Nodes nodes_;
  Caster caster_;
  RenderSetup setup_;
  const ViewSource* source_;
  std::vector<float> beam_starts_;
};

}  // namespace voxdag
