#pragma once
/// A cell of an octree under construction: its size, its position and the surface in it.
#include <cstdint>
#include <span>

#include "voxdag/builders/pieces/surface_polygon.hpp"
#include "voxdag/builders/pieces/surface_triangle.hpp"

namespace voxdag {

/// The part of a triangle that lies in a cell.
struct TrianglePiece {
  // Left uninitialised on purpose: polygons are large.
  TrianglePiece() {}  // NOLINT(clang-analyzer-optin.cplusplus.UninitializedObject): see above

  std::uint32_t triangle;    ///< Index into Cell::triangles.
  std::uint32_t conditions;  ///< The triangle's conditions that are open in the cell, as bits.
  double area;               ///< In the cell's own coordinates: its side is 2.
  SurfacePolygon polygon;
};

/// A view of a PieceStack, which may not change while the view is used.
struct Cell {
  int log2_size = 0;  ///< The cell's side is 2^log2_size voxels.
  Vec3i origin{};     ///< The cell's lower corner in the coordinates of the triangles, in voxels.
  Vec3i frame_origin{};  ///< Origin of the triangles' coordinates, in voxels of the grid.
  std::span<const SurfaceTriangle> triangles;
  std::span<const TrianglePiece> pieces;

  const SurfaceTriangle& triangle_of(const TrianglePiece& piece) const {
    return triangles[piece.triangle];
  }
  /// Returns half of the side, in voxels.
  double half_size() const { return 0.5 * static_cast<double>(std::int64_t{1} << log2_size); }
  /// Returns the centre, in the coordinates of the triangles.
  Vec3d centre() const {
    const double half = half_size();
    return static_cast<Vec3d>(origin) + Vec3d{half, half, half};
  }
  /// Returns the area of a piece in voxels².
  double area(const TrianglePiece& piece) const {
    const double half = half_size();
    return piece.area * half * half;
  }
};

}  // namespace voxdag
