#pragma once
/// From mesh coordinates to the voxel grid: which Grid, and which 1/256-voxel integers.
///
/// design: "Exact cover". A vertex v becomes q = llround((double(v) - origin) *
/// quantization_scale), component by component; everything after that is integer.
#include <cstdint>
#include <optional>

#include "voxdag/core/grid.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/mesh/mesh_bounds.hpp"
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

/// The grid of 2^levels voxels a side that fits the mesh: origin at the least corner of its bounds,
/// the longest side spanning all voxels. Throws Error if levels is outside [kMinLevels, kMaxLevels]
/// or the mesh has no triangles. A mesh that is one point gets a grid of voxels of size 1.
Grid fit_grid(const Mesh& mesh, int levels);

/// The smallest grid of voxels of `voxel_size` world units whose origin is that of fit_grid and
/// which holds the mesh. Throws Error if that takes more than kMaxLevels.
Grid grid_from_voxel_size(const Mesh& mesh, double voxel_size);

/// A grid of 2^levels voxels a side with its origin at bounds.lo whose longest side is that of
/// `bounds`; what lies outside of the grid is clipped away.
Grid grid_from_bounds(const Box3d& bounds, int levels);

/// A grid with its origin at bounds.lo, voxels of `voxel_size`, as large as `bounds` needs.
Grid grid_from_bounds(const Box3d& bounds, double voxel_size);

/// Coordinates of vertices in units of 1/256 voxel lie within ±kMaxUnits.
inline constexpr std::int32_t kMaxUnits = (1 << 29) - 1;

/// A point in units of 1/256 voxel, or nothing if it lies beyond ±kMaxUnits.
std::optional<Vec3i> quantize(const Grid& grid, Vec3d world);

using QuantizedTriangle = Vec3<Vec3i>;  ///< Three vertices in units of 1/256 voxel.

/// A mesh's triangles on the grid's integers. Refers to the mesh, which must outlive it.
class QuantizedMesh {
 public:
  /// Clips triangles with a vertex beyond ±kMaxUnits (possible only if the grid does not fit the
  /// mesh) to that box in double precision; each gives up to 7 triangles. `budget` counts the
  /// memory and `progress` is polled; both may be null. Throws OverMemory and Cancelled.
  QuantizedMesh(const Mesh& mesh, const Grid& grid, MemoryBudget* budget = nullptr,
                Progress* progress = nullptr);

  std::size_t triangle_count() const { return mesh_->triangles.size() + clipped_.size(); }
  /// The triangles of the mesh come first, then the pieces of clipped ones.
  std::size_t mesh_triangle_count() const { return mesh_->triangles.size(); }
  /// Returns false for a triangle that was clipped: its pieces stand at the end.
  bool in_range(std::size_t index) const;
  QuantizedTriangle triangle(std::size_t index) const;
  /// Returns the triangle of the mesh that triangle `index` is, or that it is a piece of.
  std::uint32_t source(std::size_t index) const {
    const std::size_t count = mesh_->triangles.size();
    return index < count ? static_cast<std::uint32_t>(index) : clipped_source_[index - count];
  }

 private:
  void clip(const Mesh& mesh, const Grid& grid, std::uint32_t index);

  const Mesh* mesh_;
  CountedVector<Vec3i> vertices_;
  CountedVector<QuantizedTriangle> clipped_;
  CountedVector<std::uint32_t> clipped_source_;
};

}  // namespace voxdag
