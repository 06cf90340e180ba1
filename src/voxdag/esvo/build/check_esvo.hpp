#pragma once
/// Whether an ESVO encloses the surface that it was made of.
#include <cstdint>
#include <optional>

#include "voxdag/displace/displaced_triangles.hpp"
#include "voxdag/layout/esvo.hpp"
#include "voxdag/surface/surface_shading.hpp"
#include "voxdag/voxelize/grid_mapping.hpp"

namespace voxdag {

/// A point of the surface that is in no leaf, or outside of its voxel's contours.
struct PointOutside {
  std::uint32_t triangle = 0;  ///< Of the mesh.
  Vec3d point{};               ///< In voxels.
  int level = 0;  ///< Of the voxel that is not there or whose contour leaves the point out.
};

struct EnclosureCheck {
  std::uint64_t points = 0;  ///< That were looked at.
  std::optional<PointOutside> outside;
};

/// Takes about `samples` random points of the mesh's triangles (rounded to 1/256 voxel, as they
/// were built), spread by area and with every triangle and its corners in turn, and walks the
/// octree to each: it must be in voxels and between the planes of every contour down to a leaf. A
/// point may be in any of the voxels within 1e-6 of a voxel of it. Points outside of the grid, and
/// points that `shading` (or null) says are cut away, are passed over. Where the mesh is
/// `displaced` (or null) the points are those of the displaced surface in `grid`, tessellated as it
/// was for building. Deterministic.
EnclosureCheck check_enclosure(const EsvoView& esvo, const QuantizedMesh& mesh, const Grid& grid,
                               const SurfaceShading* shading, const DisplacedTriangles* displaced,
                               std::uint64_t samples, std::uint64_t seed = 1,
                               Progress* progress = nullptr);

}  // namespace voxdag
