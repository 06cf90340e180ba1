#pragma once
/// Shapes of edits, and which voxels belong to them: exactly, in integers.
///
/// A voxel belongs to a shape if its centre does. Coordinates count from the grid's corner in
/// subvoxels, 1/256 of a voxel, so that the centre of voxel (i,j,k) is at 256 (i,j,k) + 128. The
/// make functions round world units to subvoxels.
#include <cstdint>
#include <variant>

#include "voxdag/core/grid.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag {

/// The place of a cell's voxels: all outside of a shape, all inside, or not decided (kMixed).
enum class CellPlace { kOutside, kMixed, kInside };

/// The largest coordinate and radius of a shape, in subvoxels: two million voxels.
inline constexpr std::int64_t kMaxShapeCoordinate = std::int64_t{1} << 29;

/// All points at most `radius` from `center`.
struct BallShape {
  Vec3l center;
  std::int64_t radius = 0;

  /// Returns where the voxels of a cell of 2^bits voxels a side are. `origin` is its first voxel.
  CellPlace place(Vec3i origin, int bits) const;
  /// Returns the mask of the voxels of the shape among the 4³ from `origin` on, in Morton order.
  std::uint64_t block(Vec3i origin) const;
};

/// All points at most `radius` from the segment between two points.
struct CapsuleShape {
  Vec3l a, b;
  std::int64_t radius = 0;

  CellPlace place(Vec3i origin, int bits) const;
  std::uint64_t block(Vec3i origin) const;
};

/// All points p with first <= dot(axis, p) < end for each of up to three axes. An axis is in units
/// of 1/65536, the limits in those of dot(axis, p).
struct SlabsShape {
  struct Slab {
    Vec3l axis;
    std::int64_t first = 0, end = 0;
  };
  static constexpr std::int64_t kAxisUnit = 65536;
  Slab slabs[3];
  int count = 0;

  CellPlace place(Vec3i origin, int bits) const;
  std::uint64_t block(Vec3i origin) const;
};

using EditShape = std::variant<BallShape, CapsuleShape, SlabsShape>;

/// Makes a ball from world units. Throws Error for values that are not finite, a negative radius,
/// and what lies beyond kMaxShapeCoordinate.
EditShape make_ball(const Grid& grid, Vec3d center, double radius);
/// Makes a capsule: a ball that moves from `a` to `b`.
EditShape make_capsule(const Grid& grid, Vec3d a, Vec3d b, double radius);
/// Makes the box from `lo` to `hi`. Boxes that share a side have no common voxel.
EditShape make_box(const Grid& grid, Vec3d lo, Vec3d hi);
/// Makes a box of size 2 `half`, turned about `center`: `axes` are its sides' directions, which
/// need unit length. Directions are rounded to 1/65536.
EditShape make_turned_box(const Grid& grid, Vec3d center, Vec3d half, const Vec3d (&axes)[3]);
/// Makes the half-space of all points p with dot(normal, p - point) < 0. `normal` need not have
/// unit length.
EditShape make_half_space(const Grid& grid, Vec3d point, Vec3d normal);

}  // namespace voxdag
