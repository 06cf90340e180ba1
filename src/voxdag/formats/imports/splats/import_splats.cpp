#include "voxdag/formats/imports/splats/import_splats.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "voxdag/core/error.hpp"
#include "voxdag/formats/imports/splats/splat_tiles.hpp"

namespace voxdag {
namespace {

/// The first pass finds the box of the centres, and the boxes of the splats, one for each binary
/// exponent of their largest standard deviations.
struct SplatExtent {
  Box3d centers = Box3d::empty();
  std::array<Box3d, 300> boxes;
  std::uint64_t count = 0, usable = 0;
};

float largest_scale(const Splat& splat) {
  return std::max({splat.scale[0], splat.scale[1], splat.scale[2]});
}

double longest_side_of(const Box3d& box) {
  const Vec3d sides = box.hi - box.lo;
  return std::max({sides.x, sides.y, sides.z});
}

bool can_be_used(Vec3d center, const Splat& splat) { return is_finite(center) && is_usable(splat); }

/// Returns the index in SplatExtent::boxes: numbers below 2^k have indices below box_index(2^k).
std::size_t box_index(double scale) {
  constexpr int kLeast = -150;
  return scale > 0 ? static_cast<std::size_t>(std::clamp(std::ilogb(scale) - kLeast, 0, 299)) : 0;
}

/// Leaves out splats with a standard deviation of `max_scale` or more.
SplatExtent extent_of_splats(const VoxelSource& source, double max_scale, Work work) {
  SplatExtent extent;
  extent.boxes.fill(Box3d::empty());
  source.visit_all([&](const VoxelBatch& batch) {
    work.poll();
    for (std::size_t i = 0; i < batch.places.size(); ++i) {
      ++extent.count;
      const Vec3d center = batch.places[i];
      const Splat& splat = batch.splats[i];
      if (!can_be_used(center, splat)) continue;
      ++extent.usable;
      extent.centers.extend(center);
      const float largest = largest_scale(splat);
      if (static_cast<double>(largest) >= max_scale) continue;
      const Vec3d reach = reach_of(splat);
      Box3d& box = extent.boxes[box_index(largest)];
      box.extend(center - reach);
      box.extend(center + reach);
    }
  });
  return extent;
}

/// Returns the greatest power of two that is not above 1/64 of the side.
double default_max_scale(double longest_side) {
  return longest_side > 0 ? std::ldexp(1.0, std::ilogb(longest_side / 64))
                          : std::numeric_limits<double>::infinity();
}

struct SplatGrid {
  Grid grid;
  double max_scale;
};

SplatGrid grid_of_splats(const VoxelSource& source, const ImportOptions& options, Work work) {
  const std::optional<double> given = options.splats.max_scale;
  if (options.bounds)
    return {grid_for(Box3d::empty(), options),
            given.value_or(default_max_scale(longest_side_of(*options.bounds)))};
  const SplatExtent extent =
      extent_of_splats(source, given.value_or(std::numeric_limits<double>::infinity()), work);
  if (extent.usable == 0)
    throw Error("", "",
                extent.count > 0 ? "has only splats that are not finite, so it has no bounds"
                                 : "has no splats, so it has no bounds");
  const double max_scale = given.value_or(default_max_scale(longest_side_of(extent.centers)));
  Box3d box = Box3d::empty();
  for (std::size_t i = 0; i < (given ? extent.boxes.size() : box_index(max_scale)); ++i) {
    if (extent.boxes[i].is_empty()) continue;
    box.extend(extent.boxes[i].lo);
    box.extend(extent.boxes[i].hi);
  }
  if (box.is_empty())
    throw Error("", "",
                "has only splats that are too large, so it has no bounds: --max-scale takes larger "
                "ones");
  GridRequest request = options;
  if (!options.resolution) {
    // Splats below the origin are left out, even if those are all.
    if (options.origin) box.hi = max(box.hi, *options.origin);
    return {grid_for(box, request), max_scale};
  }
  box.lo = options.origin.value_or(box.lo);
  request.origin.reset();
  if (box.lo == box.hi) box.hi = box.lo + Vec3d{1, 1, 1} * static_cast<double>(*options.resolution);
  request.bounds = box;
  return {grid_for(Box3d::empty(), request), max_scale};
}

}  // namespace

ImportResult import_splats(const VoxelSource& source, const ImportOptions& options, Work work) {
  ImportResult result;
  const auto [grid, max_scale] = grid_of_splats(source, options, work);
  result.grid = grid;
  const double opacity = options.splats.opacity.value_or(0.1),
               min_scale = options.splats.min_scale.value_or(grid.voxel_size / 2);
  result.splats = {opacity, min_scale, max_scale};
  const SplatPlacing placing{
      grid, min_scale,
      std::max<std::uint64_t>(
          1, static_cast<std::uint64_t>(std::ceil(-std::log1p(-opacity) * kExtinctionUnits))),
      options.colors && source.has_colors()};
  SplatTiles tiles(placing, options.folder, work);
  source.visit_all([&](const VoxelBatch& batch) {
    work.poll();
    result.read += batch.places.size();
    for (std::size_t i = 0; i < batch.places.size(); ++i) {
      const Splat& splat = batch.splats[i];
      if (!can_be_used(batch.places[i], splat))
        ++result.not_finite;
      else if (static_cast<double>(largest_scale(splat)) >= max_scale)
        ++result.too_large;
      else if (!tiles.add(batch.places[i], splat, placing.has_colors ? batch.colors[i] : Rgb8{}))
        ++result.outside;
    }
  });
  SplatTiles::Result built = tiles.finish(color_bound_of(source, options));
  result.dag = std::move(built.dag);
  result.attributes = std::move(built.attributes);
  return result;
}

}  // namespace voxdag
