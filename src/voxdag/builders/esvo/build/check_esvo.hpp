#pragma once
/// Checks that an ESVO encloses the surface that it was built from.
#include <cstdint>
#include <optional>

#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/mesh/displace/displaced_triangles.hpp"
#include "voxdag/mesh/surface/surface_shading.hpp"
#include "voxdag/stored/esvo/esvo.hpp"

namespace voxdag {

/// A point of the surface that is in no leaf, or outside its voxel's contours.
struct PointOutside {
  std::uint32_t triangle = 0;  ///< Index in the mesh.
  Vec3d point{};               ///< In units of voxels.
  int level = 0;               ///< Level of the voxel that is missing or excludes the point.
};

struct EnclosureCheck {
  std::uint64_t points = 0;  ///< Number of points checked.
  std::optional<PointOutside> outside;
};

/// Checks about `samples` random points of the mesh's triangles, which are rounded to 1/256 voxel
/// as for building. Some points are spread by area; others are taken from each triangle and its
/// corners in turn. The octree must contain each point: in voxels and between the planes of their
/// contours, down to a leaf. Voxels are widened by 1e-6 of a voxel for this test. Skips points
/// outside the grid, and points that `shading` masks away by alpha. If `displaced` is not null,
/// takes the points from the displaced surface, tessellated as for building. `shading` and
/// `displaced` may be null. The result depends on the arguments alone.
EnclosureCheck check_enclosure(const EsvoView& esvo, const QuantizedMesh& mesh, const Grid& grid,
                               const SurfaceShading* shading, const DisplacedTriangles* displaced,
                               std::uint64_t samples, std::uint64_t seed = 1, Work work = {});

}  // namespace voxdag
