#pragma once
/// Fills the inside of meshes.
#include <cstdint>

#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/mesh/mesh.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

enum class SolidRule {
  /// A voxel is inside if a ray from it crosses an odd number of triangles. Exact for closed
  /// meshes, which may intersect themselves and be nested. Where two bodies overlap, they cancel
  /// each other out.
  kParity,
  /// A voxel is inside if the absolute generalised winding number of the mesh at its centre is at
  /// least a threshold. For meshes with holes, overlapping bodies and triangles of both windings.
  /// Exact, except where the winding number is within 1e-8 of the threshold.
  kWinding,
  /// An empty voxel is inside if no way over faces through empty voxels connects it with the sides
  /// of the grid. For meshes whose voxels leave no gap. It fills cavities, too.
  kFlood,
};

struct SolidOptions {
  SolidRule rule = SolidRule::kParity;
  double winding_threshold = 0.5;  ///< Positive; for kWinding.
  /// Whether the solid has exactly the voxels whose centre is inside. A centre on the surface
  /// belongs to one side, so that bodies that touch share no voxel. Not for kFlood. kWinding tests
  /// a point less than 1/256 voxel beside the centre.
  bool by_centre = false;
};

/// Returns the minimal DAG, in canonical order, of the voxels of `cover`, which must be the DAG of
/// the mesh on this grid, and of those inside. No triangle meets the empty voxels, so all voxels of
/// a connected set of them are inside or none is, but for kWinding in holes. Time and memory grow
/// with `cover`, the mesh and the area of its holes, not with the voxels.
///
/// A face of the mesh that lies exactly between voxels belongs to the voxels on its inner side. The
/// solid lacks the voxels beyond it, which the body only touches, unless they touch such faces both
/// with lower and with upper sides. kFlood keeps all voxels of the cover.
///
/// kParity throws Error if the mesh is not closed. kParity and kWinding throw Error if the mesh
/// reaches out of the range of QuantizedMesh. kFlood throws Error for by_centre. Throws OverMemory
/// and Cancelled.
Svdag fill_solid(const SvdagView& cover, const Mesh& mesh, const Grid& grid,
                 const SolidOptions& options, Work work = {});

}  // namespace voxdag
