#include "voxdag/formats/imports/splats/splat_tiles.hpp"

#include <algorithm>
#include <bit>

#include "voxdag/core/parallel/ordered_pipeline.hpp"
#include "voxdag/core/parallel/thread_count.hpp"
#include "voxdag/formats/imports/colors/cell_colors.hpp"
#include "voxdag/formats/imports/colors/linear_color.hpp"
#include "voxdag/stored/svdag/for_each_voxel.hpp"

namespace voxdag {
namespace {

/// Colours that are written and read at a time.
constexpr std::size_t kColorChunk = std::size_t{1} << 20;

/// Returns how many splats to hold, at most 512 MiB of them.
std::size_t splats_in_memory(const MemoryBudget* memory, std::size_t bytes_per_splat) {
  const std::size_t most = (std::size_t{512} << 20) / bytes_per_splat;
  if (memory == nullptr || memory->limit() == 0) return most;
  return std::min<std::size_t>(most, memory->left() / 3 / bytes_per_splat);
}

/// Calls visit(cell) for the cells of `side` voxels that a box meets, in any order.
template <class Visit>
void each_cell(const Box3i& box, std::int32_t side, const Visit& visit) {
  for (std::int32_t z = box.lo.z / side; z * side < box.hi.z; ++z)
    for (std::int32_t y = box.lo.y / side; y * side < box.hi.y; ++y)
      for (std::int32_t x = box.lo.x / side; x * side < box.hi.x; ++x) visit(Vec3i{x, y, z});
}

Box3i box_of(Vec3i cell, std::int32_t side) {
  return {cell * side, (cell + Vec3i{1, 1, 1}) * side};
}

}  // namespace

SplatTiles::SplatTiles(const SplatPlacing& placing, const std::filesystem::path& folder, Work work)
    : placing_(placing),
      work_(work),
      records_(std::in_place, splats_in_memory(work.memory, sizeof(Record)), folder, work),
      // A batch, the bricks of a tile that is open, and for each thread a brick and two tiles of
      // voxels.
      buffers_(work.memory, kBatch * (sizeof(Record) + 2 * sizeof(GridSplat)) +
                                (kBricks + thread_count()) * (std::size_t{5} << 18) +
                                thread_count() * (std::size_t{16} << 20)),
      builder_(placing.grid.levels, work.memory) {
  if (placing.has_colors) color_file_.emplace(folder);
}

bool SplatTiles::add(Vec3d center, const Splat& splat, Rgb8 color) {
  const Grid& grid = placing_.grid;
  Record record{0, (center - grid.origin) * (1 / grid.voxel_size) - Vec3d{0.5, 0.5, 0.5}, splat,
                color};
  const GridSplat in_grid = placed(record);
  const Vec3i sides = in_grid.box.hi - in_grid.box.lo;
  if (std::min({sides.x, sides.y, sides.z}) <= 0) return false;
  each_cell(in_grid.box, kTileSide, [&](Vec3i tile) {
    if (misses(in_grid, box_of(tile, kTileSide))) return;
    record.tile = morton_encode(tile);
    records_->add(record);
    work_.poll_seldom(++added_);
  });
  return true;
}

SplatTiles::Result SplatTiles::finish(double color_bound) {
  records_->visit_all([&](const Record& record) { sum(record); });
  if (open_.empty()) {
    sum_batch();
  } else {
    open_tile();
    close_tile();
  }
  records_.reset();
  Result result;
  result.dag = builder_.finish();
  if (!placing_.has_colors) return result;
  const SvdagView dag = result.dag.view();
  const MemoryReservation dag_bytes(work_.memory, dag.bytes());
  std::vector<Rgb8> colors;
  std::size_t next = 0;
  std::uint64_t left = color_count_;
  if (left <= kColorChunk) {
    colors.swap(colors_);  // None is in the file.
    left = 0;
  } else {
    color_file_->write(colors_.data(), colors_.size() * sizeof(Rgb8), work_);
  }
  const auto next_color = [&] {
    if (next == colors.size()) {
      colors.resize(static_cast<std::size_t>(std::min<std::uint64_t>(left, kColorChunk)));
      color_file_->read(colors.data(), colors.size() * sizeof(Rgb8),
                        (color_count_ - left) * sizeof(Rgb8));
      left -= colors.size();
      next = 0;
    }
    return colors[next++];
  };
  result.attributes = encode_cell_colors(dag, color_bound, work_.memory, [&](CellColors& cells) {
    std::uint64_t polled = 0;
    for_each_leaf_block(dag, whole_grid(dag.levels), [&](Vec3i first, std::uint64_t voxels) {
      work_.poll_seldom(polled++);
      const std::uint64_t code = morton_encode(first);
      for (; voxels != 0; voxels &= voxels - 1)
        cells.add(code + static_cast<std::uint64_t>(std::countr_zero(voxels)), next_color());
    });
  });
  return result;
}

GridSplat SplatTiles::placed(const Record& record) const {
  GridSplat splat =
      grid_splat(record.splat, record.center, placing_.grid.voxel_size, placing_.min_scale,
                 static_cast<std::int32_t>(placing_.grid.resolution()));
  for (std::size_t c = 0; c < 3; ++c) splat.color[c] = linear_of(record.color[c]);
  return splat;
}

/// Takes the splats in the order of tiles.
void SplatTiles::sum(const Record& record) {
  if (batch_.empty() || record.tile != batch_.back().tile) {
    if (!open_.empty()) {
      open_tile();
      close_tile();
    } else if (batch_.size() >= kBatch) {
      sum_batch();
    }
    tile_begin_.push_back(batch_.size());
  } else if (batch_.size() - tile_begin_.back() >= kBatch) {
    open_tile();
    tile_begin_.push_back(0);
  }
  batch_.push_back(record);
}

/// Finds which splats of a tile reach which bricks. All records have one tile.
void SplatTiles::list(std::span<const Record> records, TileSplats& tile) const {
  const Box3i tile_box = box_of(morton_decode(records.front().tile), kTileSide);
  tile.splats.clear();
  for (std::vector<std::uint32_t>& one : tile.lists) one.clear();
  for (const Record& record : records) {
    GridSplat splat = placed(record);
    splat.box = {max(splat.box.lo, tile_box.lo), min(splat.box.hi, tile_box.hi)};
    each_cell(splat.box, SplatBrick::kSide, [&](Vec3i brick) {
      if (misses(splat, box_of(brick, SplatBrick::kSide))) return;
      tile.lists[morton_encode(brick) % kBricks].push_back(
          static_cast<std::uint32_t>(tile.splats.size()));
    });
    tile.splats.push_back(splat);
  }
}

void SplatTiles::add_voxels(const SplatBrick& brick, TileVoxels& voxels) const {
  brick.each_block([&](Vec3i first, std::uint64_t block) {
    voxels.blocks.emplace_back(morton_encode(first) / 64, block);
    if (!placing_.has_colors) return;
    for (std::uint64_t left = block; left != 0; left &= left - 1) {
      const auto mean = brick.mean_color(
          first + morton_decode(static_cast<std::uint64_t>(std::countr_zero(left))));
      voxels.colors.push_back({encoded_of(mean[0]), encoded_of(mean[1]), encoded_of(mean[2])});
    }
  });
}

SplatTiles::TileVoxels SplatTiles::voxels_of(std::span<const Record> records) {
  Scratch& scratch = scratch_.local();
  list(records, scratch.tile);
  if (!scratch.brick) scratch.brick.emplace(placing_.least, placing_.has_colors);
  const Vec3i first = morton_decode(records.front().tile) * kTileSide;
  TileVoxels voxels;
  for (std::size_t i = 0; i < kBricks; ++i) {
    if (scratch.tile.lists[i].empty()) continue;
    scratch.brick->start(first + morton_decode(i) * SplatBrick::kSide);
    for (const std::uint32_t splat : scratch.tile.lists[i])
      scratch.brick->add(scratch.tile.splats[splat]);
    add_voxels(*scratch.brick, voxels);
  }
  return voxels;
}

void SplatTiles::use(const TileVoxels& voxels) {
  for (const auto& [code, block] : voxels.blocks) builder_.add_block(code, block);
  color_count_ += voxels.colors.size();
  for (const Rgb8 color : voxels.colors) {
    if (colors_.size() == kColorChunk) {
      color_file_->write(colors_.data(), colors_.size() * sizeof(Rgb8), work_);
      colors_.clear();
    }
    colors_.push_back(color);
  }
}

/// Sums the tiles of the batch, which are complete.
void SplatTiles::sum_batch() {
  tile_begin_.push_back(batch_.size());
  ordered_pipeline(
      tile_begin_.size() - 1, 2 * thread_count(), work_,
      [&](std::size_t tile) {
        return voxels_of(std::span(batch_).subspan(tile_begin_[tile],
                                                   tile_begin_[tile + 1] - tile_begin_[tile]));
      },
      [&](const TileVoxels& voxels) { use(voxels); });
  summed_ += batch_.size();
  work_.report_done("splats", summed_, added_);
  batch_.clear();
  tile_begin_.clear();
}

/// Sums the tiles of the batch, and adds the splats of the last one to its bricks, which stay open.
void SplatTiles::open_tile() {
  const std::vector<Record> last(batch_.begin() + static_cast<std::ptrdiff_t>(tile_begin_.back()),
                                 batch_.end());
  if (open_.empty()) {
    batch_.resize(tile_begin_.back());
    tile_begin_.pop_back();
    sum_batch();
    open_.resize(kBricks);
  }
  batch_.clear();
  tile_begin_.clear();
  if (last.empty()) return;
  TileSplats& tile = scratch_.local().tile;
  list(last, tile);
  const Vec3i first = morton_decode(last.front().tile) * kTileSide;
  polled_for(kBricks, 1, work_, "splats", [&](std::size_t i) {
    if (tile.lists[i].empty()) return;
    if (open_[i] == nullptr) {
      open_[i] = std::make_unique<SplatBrick>(placing_.least, placing_.has_colors);
      open_[i]->start(first + morton_decode(i) * SplatBrick::kSide);
    }
    for (const std::uint32_t splat : tile.lists[i]) open_[i]->add(tile.splats[splat]);
  });
  summed_ += last.size();
}

void SplatTiles::close_tile() {
  TileVoxels voxels;
  for (const auto& brick : open_)
    if (brick != nullptr) add_voxels(*brick, voxels);
  open_.clear();
  use(voxels);
}

}  // namespace voxdag
