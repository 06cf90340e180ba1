#pragma once
/// Maps mesh coordinates to the voxel grid: chooses the Grid and rounds vertices to 1/256 voxel.
///
/// design: "Exact cover". A vertex v, as Mesh::position() returns it, becomes q = llround((v -
/// origin) * quantization_scale), component by component; everything after that is integer.
#include <cstdint>
#include <optional>
#include <vector>

#include "voxdag/core/grid.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/mesh/mesh_bounds.hpp"

namespace voxdag {

/// Returns the levels of the least grid of at least `voxels` voxels a side. Throws Error for other
/// numbers than 1 to 2^kMaxLevels.
int levels_of(std::int64_t voxels);

/// Returns the grid of 2^levels voxels a side that fits the mesh: its origin is the lower corner of
/// the mesh's bounds, and the longest side spans all voxels. Throws Error if levels is outside
/// [kMinLevels, kMaxLevels] or the mesh has no triangles. A mesh that is one point gets a grid of
/// voxels of size 1.
Grid fit_grid(const Mesh& mesh, int levels);
/// Returns the grid that fits a mesh with these bounds: of the vertices that its triangles use.
Grid fit_grid(const Box3d& bounds, int levels);

/// Returns the least grid in which the longest side of a mesh with these bounds spans `voxels`
/// voxels, 1 to 2^kMaxLevels: fit_grid() for any number. The other voxels stay empty.
Grid fit_voxels(const Box3d& bounds, std::int64_t voxels);

/// Returns the smallest grid that holds the mesh, with voxels of `voxel_size` world units and the
/// origin of fit_grid(). Throws Error if it needs more than kMaxLevels levels.
Grid grid_from_voxel_size(const Mesh& mesh, double voxel_size);
/// Returns that grid for a mesh with these bounds.
Grid grid_from_voxel_size(const Box3d& bounds, double voxel_size);

/// Returns the grid of 2^levels voxels a side whose origin is bounds.lo and whose side is the
/// longest side of `bounds`. Parts of a mesh outside the grid are clipped away.
Grid grid_from_bounds(const Box3d& bounds, int levels);

/// Returns the least grid with its origin at bounds.lo in which the longest side of `bounds` spans
/// `voxels` voxels, 1 to 2^kMaxLevels: grid_from_bounds() for any number.
Grid divide_bounds(const Box3d& bounds, std::int64_t voxels);

/// Returns the smallest grid that holds `bounds`, with its origin at bounds.lo and voxels of
/// `voxel_size` world units.
Grid grid_from_bounds(const Box3d& bounds, double voxel_size);

/// Coordinates of vertices in units of 1/256 voxel lie within ±kMaxUnits.
inline constexpr std::int32_t kMaxUnits = (1 << 29) - 1;

/// Returns a point in units of 1/256 voxel, or nothing if it lies beyond ±kMaxUnits.
std::optional<Vec3i> quantize(const Grid& grid, Vec3d world);

using QuantizedTriangle = Vec3<Vec3i>;  ///< Three vertices in units of 1/256 voxel.

/// Appends a triangle on the grid's integers to `triangles`. If a corner lies beyond ±kMaxUnits,
/// appends the pieces, at most 7, that are left when the triangle is clipped to that box in double
/// precision.
void quantize_triangle(const Grid& grid, const Vec3<Vec3d>& corners,
                       std::vector<QuantizedTriangle>& triangles);

/// A mesh's triangles on the grid's integers. Refers to the mesh, which must outlive it.
class QuantizedMesh {
 public:
  /// Clips triangles with a vertex beyond ±kMaxUnits to that box, in double precision; each gives
  /// up to 7 triangles. Such triangles exist only if the grid does not fit the mesh. Throws
  /// OverMemory and Cancelled.
  QuantizedMesh(const Mesh& mesh, const Grid& grid, Work work = {});
  /// Takes triangles that are on the grid's integers already. There is no mesh behind them, so
  /// source() has no meaning.
  explicit QuantizedMesh(CountedVector<QuantizedTriangle> triangles);

  /// Returns the number of triangles, with the pieces of clipped ones.
  std::size_t triangle_count() const { return mesh_->triangles.size() + added_.size(); }
  /// Returns the number of the mesh's triangles. They come first, then the pieces of clipped
  /// triangles.
  std::size_t mesh_triangle_count() const { return mesh_->triangles.size(); }
  /// Returns false if the triangle was clipped; its pieces are at the end.
  bool in_range(std::size_t index) const;
  /// Returns triangle `index`, which must be in_range().
  QuantizedTriangle triangle(std::size_t index) const;
  /// Returns the index of the mesh's triangle that triangle `index` is, or is a piece of.
  std::uint32_t source(std::size_t index) const {
    const std::size_t count = mesh_->triangles.size();
    return index < count ? static_cast<std::uint32_t>(index) : added_source_[index - count];
  }

 private:
  const Mesh* mesh_;
  CountedVector<Vec3i> vertices_;  ///< Of the mesh.
  /// The triangles after those of the mesh: pieces of clipped ones, or all if there is no mesh.
  CountedVector<QuantizedTriangle> added_;
  CountedVector<std::uint32_t> added_source_;  ///< The mesh's triangle of each piece.
};

}  // namespace voxdag
