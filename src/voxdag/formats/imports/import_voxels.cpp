#include "voxdag/formats/imports/import_voxels.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string>

#include "voxdag/algebra/voxels/voxel_builder.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/formats/imports/colors/colored_voxel_builder.hpp"

namespace voxdag {
namespace {

/// Voxels in memory at a time, without a limit: 512 MiB.
constexpr std::size_t kMaxBufferedVoxels = std::size_t{1} << 26;

std::size_t voxels_in_memory(const MemoryBudget* memory, std::size_t bytes_per_voxel) {
  if (memory == nullptr || memory->limit() == 0) return kMaxBufferedVoxels;
  // The other half is for the nodes.
  return std::min<std::size_t>(kMaxBufferedVoxels, memory->left() / 2 / bytes_per_voxel);
}

/// The least and greatest coordinates in the file.
struct Extent {
  Vec3d lo{HUGE_VAL, HUGE_VAL, HUGE_VAL}, hi{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
  std::uint64_t count = 0;
};

Extent extent_of(const VoxelSource& source, Work work) {
  Extent extent;
  source.visit_all([&](const VoxelBatch& batch) {
    work.poll();
    for (const Vec3d p : batch.places) {
      for (int axis = 0; axis < 3; ++axis)
        if (!std::isfinite(p[axis]))
          throw Error("", "", "point " + std::to_string(extent.count) + " is not finite");
      ++extent.count;
      extent.lo = min(extent.lo, p);
      extent.hi = max(extent.hi, p);
    }
  });
  return extent;
}

Grid grid_of_voxels(const VoxelSource& source, const ImportOptions& options, Work work) {
  Grid grid = source.grid().value_or(Grid{});
  if (!source.grid()) {
    const Extent extent = extent_of(source, work);
    const double most = std::max({extent.hi.x, extent.hi.y, extent.hi.z, 0.0});
    grid.levels =
        std::max(kMinLevels, static_cast<int>(std::bit_width(static_cast<std::uint64_t>(most))));
    if (grid.levels > kMaxLevels)
      throw Error("", "", "has voxels beyond 1048575, the last one of the largest grid");
    grid.quantization_scale = kSubvoxels / grid.voxel_size;
  }
  grid.levels = options.levels.value_or(grid.levels);
  return grid;
}

Grid grid_of_points(const VoxelSource& source, const ImportOptions& options, Work work) {
  Box3d bounds;
  if (options.bounds) {
    bounds = *options.bounds;
  } else {
    const Extent extent = extent_of(source, work);
    if (extent.count == 0) throw Error("", "", "has no points, so it has no bounds");
    bounds = {extent.lo, extent.hi};
    // One point has a grid of voxels of size 1, as a mesh of one point has.
    if (!(bounds.lo.x < bounds.hi.x) && !(bounds.lo.y < bounds.hi.y) &&
        !(bounds.lo.z < bounds.hi.z))
      bounds.hi = bounds.lo + Vec3d{1, 1, 1} * std::ldexp(1.0, options.levels.value_or(2));
  }
  return options.levels ? grid_from_bounds(bounds, *options.levels)
                        : grid_from_bounds(bounds, *options.voxel_size);
}

/// Returns the voxel of a point; none if it lies outside of the grid.
std::optional<Vec3i> voxel_of_point(Vec3d point, const Grid& grid, bool has_bounds) {
  const double side = std::ldexp(1.0, grid.levels);
  Vec3i voxel;
  for (int axis = 0; axis < 3; ++axis) {
    double at = std::floor((point[axis] - grid.origin[axis]) / grid.voxel_size);
    // The upper sides of the bounding box, also after rounding.
    if (!has_bounds) at = std::clamp(at, 0.0, side - 1);
    if (!(at >= 0 && at < side)) return std::nullopt;
    voxel[axis] = static_cast<std::int32_t>(at);
  }
  return voxel;
}

}  // namespace

ImportResult import_voxels(const VoxelSource& source, const ImportOptions& options, Work work) {
  const bool has_points = source.has_points();
  ImportResult result;
  result.grid =
      has_points ? grid_of_points(source, options, work) : grid_of_voxels(source, options, work);
  const int levels = result.grid.levels;
  // Calls add(voxel, index) for all places in the grid.
  const auto each_voxel = [&](const VoxelBatch& batch, const auto& add) {
    work.poll();
    result.read += batch.places.size();
    for (std::size_t i = 0; i < batch.places.size(); ++i) {
      const Vec3d place = batch.places[i];
      const std::optional<Vec3i> voxel =
          has_points ? voxel_of_point(place, result.grid, options.bounds.has_value())
                     : static_cast<Vec3i>(place);
      if (voxel)
        add(*voxel, i);
      else
        ++result.outside;
    }
  };
  if (options.colors && source.has_colors()) {
    ColoredVoxelBuilder builder(levels, voxels_in_memory(work.memory, sizeof(ColoredCode)),
                                options.folder, work);
    source.visit_all([&](const VoxelBatch& batch) {
      each_voxel(batch, [&](Vec3i voxel, std::size_t i) { builder.add(voxel, batch.colors[i]); });
    });
    auto [dag, attributes] = builder.finish(options.color_bound);
    result.dag = std::move(dag);
    result.attributes = std::move(attributes);
  } else {
    VoxelBuilder builder(levels, voxels_in_memory(work.memory, sizeof(std::uint64_t)),
                         options.folder, work);
    source.visit_all([&](const VoxelBatch& batch) {
      each_voxel(batch, [&](Vec3i voxel, std::size_t) { builder.add(voxel); });
    });
    result.dag = builder.finish();
  }
  return result;
}

}  // namespace voxdag
