#include "voxdag/edit/shapes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/core/int128.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {
namespace {

constexpr std::int64_t kHalf = kSubvoxels / 2;
constexpr std::int64_t kNoLimit = std::numeric_limits<std::int64_t>::max();

/// The centres of the first and of the last voxel of a cell.
struct Centers {
  Vec3l first, last;
};

Centers centers_of(Vec3i origin, int bits) {
  const Vec3l first = Vec3l(origin) * std::int64_t{kSubvoxels} + Vec3l{kHalf, kHalf, kHalf};
  const std::int64_t span = ((std::int64_t{1} << bits) - 1) * kSubvoxels;
  return {first, first + Vec3l{span, span, span}};
}

/// Returns the mask of the voxels of a leaf block for whose centre has(center) is true.
template <class Has>
std::uint64_t block_of(Vec3i origin, const Has& has) {
  const Vec3l first = centers_of(origin, 0).first;
  std::uint64_t mask = 0;
  for (int voxel = 0; voxel < 64; ++voxel) {
    Vec3l center = first;
    for (int axis = 0; axis < 3; ++axis) center[axis] += kSubvoxels * leaf_coordinate(voxel, axis);
    mask |= std::uint64_t{has(center)} << voxel;
  }
  return mask;
}

/// The distance of a centre from a capsule's segment, against its radius.
bool is_in_capsule(const CapsuleShape& capsule, Vec3l center) {
  const Vec3l along = capsule.b - capsule.a, from_a = center - capsule.a;
  const std::int64_t t = dot(from_a, along), length2 = dot(along, along),
                     radius2 = capsule.radius * capsule.radius;
  if (t <= 0) return dot(from_a, from_a) <= radius2;
  if (t >= length2) {
    const Vec3l from_b = center - capsule.b;
    return dot(from_b, from_b) <= radius2;
  }
  return Int128{dot(from_a, from_a)} * length2 - Int128{t} * t <= Int128{radius2} * length2;
}

/// Returns about how far a point is from a capsule's segment: the error is below a subvoxel.
double distance_from_segment(const CapsuleShape& capsule, Vec3d point) {
  const Vec3d along{Vec3d(capsule.b - capsule.a)}, from_a = point - Vec3d(capsule.a);
  const double length2 = dot(along, along);
  const double t = length2 > 0 ? std::clamp(dot(from_a, along) / length2, 0.0, 1.0) : 0.0;
  return length(from_a - along * t);
}

std::int64_t subvoxels(double value, const char* what) {
  const double scaled = value * kSubvoxels;
  if (!(std::abs(scaled) <= static_cast<double>(kMaxShapeCoordinate)))
    throw Error(std::string("a shape's ") + what +
                " is not a number or lies more than two million voxels from the grid");
  return std::llround(scaled);
}

Vec3l subvoxels(const Grid& grid, Vec3d world, const char* what) {
  const Vec3d voxels = grid.to_grid(world);
  return {subvoxels(voxels.x, what), subvoxels(voxels.y, what), subvoxels(voxels.z, what)};
}

std::int64_t radius_of(const Grid& grid, double radius) {
  if (radius < 0) throw Error("a shape's radius is negative");
  return subvoxels(radius / grid.voxel_size, "radius");
}

Vec3l fixed_axis(Vec3d axis) {
  Vec3l fixed;
  for (int i = 0; i < 3; ++i) {
    if (!(std::abs(axis[i]) <= 1.0001)) throw Error("a shape's direction has no unit length");
    fixed[i] = std::llround(axis[i] * SlabsShape::kAxisUnit);
  }
  return fixed;
}

}  // namespace

CellPlace BallShape::place(Vec3i origin, int bits) const {
  const Centers cell = centers_of(origin, bits);
  std::int64_t nearest = 0, farthest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t below = cell.first[axis] - center[axis],
                       above = center[axis] - cell.last[axis];
    const std::int64_t near = std::max({below, above, std::int64_t{0}}),
                       far = std::max(-below, -above);
    nearest += near * near;
    farthest += far * far;
  }
  if (nearest > radius * radius) return CellPlace::kOutside;
  return farthest <= radius * radius ? CellPlace::kInside : CellPlace::kMixed;
}

std::uint64_t BallShape::block(Vec3i origin) const {
  const Vec3l first = centers_of(origin, 0).first - center;
  std::int64_t squares[3][4];
  for (int axis = 0; axis < 3; ++axis)
    for (int k = 0; k < 4; ++k) {
      const std::int64_t d = first[axis] + k * kSubvoxels;
      squares[axis][k] = d * d;
    }
  std::uint64_t mask = 0;
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 4; ++y) {
      // The voxels along x whose squared distance on this axis is at most `left`.
      const std::int64_t left = radius * radius - squares[1][y] - squares[2][z];
      const std::uint64_t row = std::uint64_t{squares[0][0] <= left} << leaf_bits(0, 0) |
                                std::uint64_t{squares[0][1] <= left} << leaf_bits(1, 0) |
                                std::uint64_t{squares[0][2] <= left} << leaf_bits(2, 0) |
                                std::uint64_t{squares[0][3] <= left} << leaf_bits(3, 0);
      mask |= row << (leaf_bits(y, 1) | leaf_bits(z, 2));
    }
  return mask;
}

CellPlace CapsuleShape::place(Vec3i origin, int bits) const {
  const Centers cell = centers_of(origin, bits);
  const Vec3d middle = Vec3d(cell.first + cell.last) * 0.5;
  const double reach = length(Vec3d(cell.last - cell.first)) * 0.5;
  const double distance = distance_from_segment(*this, middle);
  const auto limit = static_cast<double>(radius);
  if (distance - reach > limit + 1) return CellPlace::kOutside;
  return distance + reach < limit - 1 ? CellPlace::kInside : CellPlace::kMixed;
}

std::uint64_t CapsuleShape::block(Vec3i origin) const {
  return block_of(origin, [&](Vec3l center) {
    const double off = distance_from_segment(*this, Vec3d(center)) - static_cast<double>(radius);
    return off < -1 || (off <= 1 && is_in_capsule(*this, center));
  });
}

CellPlace SlabsShape::place(Vec3i origin, int bits) const {
  const Centers cell = centers_of(origin, bits);
  CellPlace place = CellPlace::kInside;
  for (int i = 0; i < count; ++i) {
    const Slab& slab = slabs[i];
    std::int64_t least = 0, most = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const std::int64_t a = slab.axis[axis] * cell.first[axis],
                         b = slab.axis[axis] * cell.last[axis];
      least += std::min(a, b);
      most += std::max(a, b);
    }
    if (most < slab.first || least >= slab.end) return CellPlace::kOutside;
    if (least < slab.first || most >= slab.end) place = CellPlace::kMixed;
  }
  return place;
}

std::uint64_t SlabsShape::block(Vec3i origin) const {
  return block_of(origin, [&](Vec3l center) {
    return std::all_of(slabs, slabs + count, [&](const Slab& slab) {
      const std::int64_t at = dot(slab.axis, center);
      return slab.first <= at && at < slab.end;
    });
  });
}

EditShape make_ball(const Grid& grid, Vec3d center, double radius) {
  return BallShape{subvoxels(grid, center, "centre"), radius_of(grid, radius)};
}

EditShape make_capsule(const Grid& grid, Vec3d a, Vec3d b, double radius) {
  return CapsuleShape{subvoxels(grid, a, "end"), subvoxels(grid, b, "end"),
                      radius_of(grid, radius)};
}

EditShape make_box(const Grid& grid, Vec3d lo, Vec3d hi) {
  const Vec3l first = subvoxels(grid, lo, "corner"), end = subvoxels(grid, hi, "corner");
  SlabsShape shape;
  for (int axis = 0; axis < 3; ++axis) {
    SlabsShape::Slab& slab = shape.slabs[shape.count++];
    slab.axis[axis] = SlabsShape::kAxisUnit;
    slab.first = first[axis] * SlabsShape::kAxisUnit;
    slab.end = end[axis] * SlabsShape::kAxisUnit;
  }
  return shape;
}

EditShape make_turned_box(const Grid& grid, Vec3d center, Vec3d half, const Vec3d (&axes)[3]) {
  const Vec3l middle = subvoxels(grid, center, "centre");
  SlabsShape shape;
  for (int i = 0; i < 3; ++i) {
    SlabsShape::Slab& slab = shape.slabs[shape.count++];
    slab.axis = fixed_axis(axes[i]);
    const std::int64_t at = dot(slab.axis, middle);
    const std::int64_t reach = radius_of(grid, half[i]) * SlabsShape::kAxisUnit;
    slab.first = at - reach;
    slab.end = at + reach;
  }
  return shape;
}

EditShape make_half_space(const Grid& grid, Vec3d point, Vec3d normal) {
  const double size = length(normal);
  if (!(size > 0) || !std::isfinite(size)) throw Error("a half-space's normal has no direction");
  SlabsShape shape;
  shape.count = 1;
  shape.slabs[0].axis = fixed_axis(normal * (1 / size));
  shape.slabs[0].first = -kNoLimit;
  shape.slabs[0].end = dot(shape.slabs[0].axis, subvoxels(grid, point, "point"));
  return shape;
}

}  // namespace voxdag
