#pragma once
/// Sums splats tile by tile, and joins the voxels that they set to a DAG.
#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "voxdag/algebra/voxels/morton_builder.hpp"
#include "voxdag/algebra/voxels/sorted_records.hpp"
#include "voxdag/builders/attributes/build_attributes.hpp"
#include "voxdag/builders/splats/splat_brick.hpp"
#include "voxdag/core/parallel/per_thread.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

/// How splats set voxels.
struct SplatPlacing {
  Grid grid;
  double min_scale = 0;     ///< In world units, above 0.
  std::uint64_t least = 1;  ///< The sum that sets a voxel, in units of 1 / kExtinctionUnits.
  bool has_colors = false;
};

/// Sorts splats by tiles of 128³ voxels, each into all tiles that it reaches. Then sums the splats
/// of some tiles at a time on many threads. The result depends on the set of splats alone.
class SplatTiles {
 public:
  /// Files lie in `folder`. Throws OverMemory.
  SplatTiles(const SplatPlacing& placing, const std::filesystem::path& folder, Work work);

  /// Adds a usable splat. Returns whether it reaches the grid. Throws Error, OverMemory and
  /// Cancelled.
  bool add(Vec3d center, const Splat& splat, Rgb8 color);

  struct Result {
    Svdag dag;                 ///< Minimal and in canonical order.
    DagAttributes attributes;  ///< Colours of all cells, if there are any.
  };
  /// Call it last. `color_bound`: as of ColoredVoxelBuilder. Throws Error, OverMemory and
  /// Cancelled.
  Result finish(double color_bound);

 private:
  static constexpr int kTileLevels = 7;
  static constexpr std::int32_t kTileSide = 1 << kTileLevels;
  static constexpr std::int32_t kTileBricks = kTileSide / SplatBrick::kSide;
  static constexpr std::size_t kBricks = std::size_t{kTileBricks} * kTileBricks * kTileBricks;
  /// The splats that are summed at a time.
  static constexpr std::size_t kBatch = std::size_t{1} << 16;

  struct Record {
    std::uint64_t tile;  ///< Morton code.
    Vec3d center;        ///< In voxels of the grid; the centres of voxels are whole numbers.
    Splat splat;
    Rgb8 color;

    friend bool operator==(const Record& a, const Record& b) { return a.tile == b.tile; }
    friend auto operator<=>(const Record& a, const Record& b) { return a.tile <=> b.tile; }
  };
  /// The splats of a tile, and which of them reach which brick.
  struct TileSplats {
    std::vector<GridSplat> splats;
    std::array<std::vector<std::uint32_t>, kBricks> lists;
  };
  struct Scratch {
    TileSplats tile;
    std::optional<SplatBrick> brick;
  };
  /// The voxels of a tile in Morton order.
  struct TileVoxels {
    std::vector<std::pair<std::uint64_t, std::uint64_t>> blocks;  ///< Code and voxels.
    std::vector<Rgb8> colors;
  };

  GridSplat placed(const Record& record) const;
  void sum(const Record& record);
  void list(std::span<const Record> records, TileSplats& tile) const;
  void add_voxels(const SplatBrick& brick, TileVoxels& voxels) const;
  TileVoxels voxels_of(std::span<const Record> records);
  void use(const TileVoxels& voxels);
  void sum_batch();
  void open_tile();
  void close_tile();

  SplatPlacing placing_;
  Work work_;
  std::optional<SortedRecords<Record, Repeats::kKept>> records_;
  std::uint64_t added_ = 0, summed_ = 0;
  MemoryReservation buffers_;
  PerThread<Scratch> scratch_;
  std::vector<Record> batch_;            ///< In the order of tiles.
  std::vector<std::size_t> tile_begin_;  ///< In `batch_`.
  /// The bricks of a tile whose splats are more than a batch.
  std::vector<std::unique_ptr<SplatBrick>> open_;
  MortonBuilder builder_;
  std::optional<RunFile> color_file_;
  std::vector<Rgb8> colors_;  ///< Those that are not yet in the file.
  std::uint64_t color_count_ = 0;
};

}  // namespace voxdag
