#pragma once
/// Colours and normals of the pieces of triangles in a cell.
#include <optional>
#include <span>

#include "voxdag/builders/pieces/cell.hpp"
#include "voxdag/mesh/surface/surface_shading.hpp"

namespace voxdag {

/// The colour of surfaces without a colour, in linear light.
inline constexpr Vec3f kSurfaceGrey{0.62f, 0.60f, 0.57f};

/// The corners of a piece in the triangle's barycentric coordinates, as SurfaceShading takes them.
/// Empty if the triangle has one colour and one normal.
struct PieceCorners {
  PieceCorners() {}
  operator std::span<const Vec2f>() const { return {points, count}; }

  std::size_t count = 0;
  union {
    Vec2f points[SurfacePolygon::kMaxCorners];  // uninitialised
  };
};

class PieceSampler {
 public:
  /// If `shading` is null, surfaces are grey and have the normals of their triangles. Without
  /// `with_normals`, samples of surfaces with shading have no normals: they are zero.
  explicit PieceSampler(const SurfaceShading* shading, bool with_normals = true)
      : shading_(shading), with_normals_(with_normals) {}

  /// Returns the common sample of all points of a triangle, or nothing if they differ.
  std::optional<SurfaceSample> constant_sample(const SurfaceTriangle& triangle) const;

  PieceCorners corners(const Cell& cell, const TrianglePiece& piece) const;
  /// Returns the mean over a piece; `corners` is corners() of the piece.
  SurfaceSample sample(const Cell& cell, const TrianglePiece& piece,
                       const PieceCorners& corners) const;
  SurfaceSample sample(const Cell& cell, const TrianglePiece& piece) const {
    return sample(cell, piece, corners(cell, piece));
  }

  /// Returns whether the alpha test removes every point of a piece.
  bool is_alpha_masked(const Cell& cell, const TrianglePiece& piece) const;

  /// Returns whether a triangle has the normal of its plane, not the normal from `shading`.
  bool has_own_normal(const SurfaceTriangle& triangle) const {
    return shading_ == nullptr || triangle.is_displaced;
  }

  const SurfaceShading* shading() const { return shading_; }

 private:
  const SurfaceShading* shading_;
  bool with_normals_;
};

}  // namespace voxdag
