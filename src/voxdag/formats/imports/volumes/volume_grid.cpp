#include "voxdag/formats/imports/volumes/volume_grid.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "voxdag/core/error.hpp"
#include "voxdag/formats/imports/batched_voxels.hpp"

namespace voxdag {
namespace {

/// Spacings that differ by less are equal but for rounding.
constexpr double kSameSpacing = 1e-5;
constexpr double kMaxCoordinate = 1e30;
/// Cubes of a voxel: far more than real volumes need.
constexpr double kMaxCubes = 4096;

std::string text_of(double value) {
  char text[32];
  const auto result = std::to_chars(text, text + sizeof text, value, std::chars_format::general, 6);
  return {text, result.ptr};
}

/// Returns the axes of the world that are nearest to three directions: each axis once.
std::array<int, 3> nearest_axes(const std::array<Vec3d, 3>& directions) {
  std::array<int, 3> axes{0, 1, 2}, best = axes;
  double greatest = -1;
  do {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i)
      sum += std::abs(directions[i][axes[i]]) / length(directions[i]);
    if (sum <= greatest) continue;
    greatest = sum;
    best = axes;
  } while (std::next_permutation(axes.begin(), axes.end()));
  return best;
}

/// Returns whether a direction is that of an axis, or against it, but for 0.003 degrees.
bool is_along(Vec3d direction, int axis) {
  return std::abs(direction[axis]) >= length(direction) * (1 - 1e-9);
}

void check_placement(const std::filesystem::path& path, const Vec3d& spacing,
                     const VolumePlacement& placement) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!(spacing[axis] >= 1 / kMaxCoordinate && spacing[axis] <= kMaxCoordinate))
      throw Error(path.string(), "header",
                  "the spacing of the voxels must be between 1e-30 and 1e30, not " +
                      text_of(spacing[axis]));
    if (placement.first_centre && !(std::abs((*placement.first_centre)[axis]) <= kMaxCoordinate))
      throw Error(path.string(), "header", "the volume lies beyond 1e30");
  }
}

}  // namespace

Grid grid_of_scene(const std::filesystem::path& path, Vec3l lo, Vec3l hi) {
  constexpr std::int64_t kMaxSide = std::int64_t{1} << kMaxLevels;
  const Vec3l sides = hi - lo;
  const std::int64_t longest = std::max({sides.x, sides.y, sides.z, std::int64_t{1}});
  if (longest > kMaxSide)
    throw Error(path.string(), "",
                "the scene is " + std::to_string(longest) + " voxels long, more than 1048576");
  Grid grid;
  const auto side = static_cast<std::uint64_t>(longest);
  grid.levels = levels_of({side, side, side});
  grid.origin = static_cast<Vec3d>(lo);
  return grid;
}

double VolumeMap::Axis::first_cube(double count) const {
  return std::ceil(count * cubes_per_voxel - 0.5);
}

VolumeMap::VolumeMap(const std::filesystem::path& path, const VolumeSize& size,
                     const VolumePlacement& placement, std::vector<std::string>& warnings) {
  const Vec3d spacing{length(placement.steps[0]), length(placement.steps[1]),
                      length(placement.steps[2])};
  check_placement(path, spacing, placement);
  const double least = std::min({spacing.x, spacing.y, spacing.z}),
               greatest = std::max({spacing.x, spacing.y, spacing.z});
  if (const double cubes = spacing.x / least * (spacing.y / least) * (spacing.z / least);
      !(cubes <= kMaxCubes))
    throw Error(path.string(), "header",
                "the voxels are boxes of " + text_of(spacing.x) + " x " + text_of(spacing.y) +
                    " x " + text_of(spacing.z) + ", which would become more than 4096 cubes each");
  const bool are_cubes = greatest <= least * (1 + kSameSpacing);
  const double side = are_cubes ? spacing.x : least;
  const std::array<int, 3> world = nearest_axes(placement.steps);
  bool is_turned = placement.is_curved;
  VolumeSize cubes{};
  Vec3d origin;
  for (std::size_t i = 0; i < 3; ++i) {
    Axis& axis = axes_[i];
    axis.world = world[i];
    axis.is_mirrored = placement.steps[i][axis.world] < 0;
    is_turned |= !is_along(placement.steps[i], axis.world);
    const double step = spacing[static_cast<int>(i)], ratio = are_cubes ? 1 : step / side,
                 whole = std::round(ratio);
    axis.cubes_per_voxel = std::abs(ratio - whole) <= kSameSpacing * whole ? whole : ratio;
    axis.voxels = static_cast<double>(size[i]);
    cubes[static_cast<std::size_t>(axis.world)] =
        static_cast<std::uint64_t>(axis.first_cube(axis.voxels));
    const double centre = placement.first_centre ? (*placement.first_centre)[axis.world]
                                                 : (axis.is_mirrored ? -step : step) / 2;
    origin[axis.world] =
        axis.is_mirrored ? centre + step / 2 - axis.voxels * step : centre - step / 2;
    is_identity_ &= axis.world == static_cast<int>(i) && !axis.is_mirrored && ratio == 1;
  }
  check_volume_size(path, cubes);
  grid_ = {levels_of(cubes), origin, side, kSubvoxels / side};
  if (!are_cubes)
    warnings.push_back("the voxels are boxes of " + text_of(spacing.x) + " x " +
                       text_of(spacing.y) + " x " + text_of(spacing.z) +
                       "; they become cubes of side " + text_of(side));
  if (is_turned)
    warnings.emplace_back(
        "the file turns or shears the volume in space; its voxels are read along the nearest axes");
}

void VolumeMap::visit_cubes(const VoxelBatch& voxels, const VisitBatch& visit) const {
  if (is_identity_) return visit(voxels);
  BatchedVoxels out(visit);
  const std::size_t each =
      voxels.places.empty() ? 0 : voxels.channels.size() / voxels.places.size();
  for (std::size_t i = 0; i < voxels.places.size(); ++i) {
    Vec3d lo, hi;
    for (int v = 0; v < 3; ++v) {
      const Axis& axis = axes_[static_cast<std::size_t>(v)];
      const double place = voxels.places[i][v],
                   before = axis.is_mirrored ? axis.voxels - 1 - place : place;
      lo[axis.world] = axis.first_cube(before);
      hi[axis.world] = axis.first_cube(before + 1);
    }
    for (double z = lo.z; z < hi.z; ++z)
      for (double y = lo.y; y < hi.y; ++y)
        for (double x = lo.x; x < hi.x; ++x) {
          if (!voxels.labels.empty()) out.add_label(voxels.labels[i]);
          for (std::size_t c = 0; c < each; ++c) out.add_channel(voxels.channels[i * each + c]);
          if (voxels.colors.empty())
            out.add({x, y, z});
          else
            out.add({x, y, z}, voxels.colors[i]);
        }
  }
  out.finish();
}

}  // namespace voxdag
