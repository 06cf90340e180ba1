#pragma once
/// The generalised winding number of a mesh at voxels, and the voxels at which the inside of a mesh
/// with holes ends without a surface.
///
/// Source: Jacobson, Kavan and Sorkine-Hornung, "Robust Inside-Outside Segmentation using
/// Generalized Winding Numbers", SIGGRAPH 2013. It tells how often the surface winds around a
/// point: a whole number if the mesh is closed, and near one far away from the holes of others.
///
/// Mesh and caps over its holes together are closed. So their winding number is a whole number,
/// which the crossings of one ray tell exactly, and the caps, which are few, tell the difference.
#include <span>
#include <vector>

#include "voxdag/builders/solid/winding/edge_tree.hpp"
#include "voxdag/builders/solid/winding/winding_tree.hpp"
#include "voxdag/core/page_vector.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

class WindingField {
 public:
  /// A voxel is inside if the absolute winding number at its centre is at least `threshold`, which
  /// is positive. All triangles of the mesh, which must outlive this object, must be in range.
  /// Throws OverMemory and Cancelled.
  WindingField(const QuantizedMesh& mesh, double threshold, Work work)
      : WindingField(mesh, find_boundary_edges(mesh, work), threshold, work) {}

  /// Returns whether each voxel is inside; no triangle may meet these voxels. Voxels whose winding
  /// number is within 1e-8 of the threshold may be on either side. Time grows with the triangles,
  /// and with the voxels that lie behind each of them along x. Throws OverMemory and Cancelled.
  std::vector<bool> are_inside(std::span<const Vec3i> voxels, Work work) const;

  /// Returns whether two voxels in a cell of 2^log2_side voxels a side that are connected through
  /// voxels that no triangle meets can be on different sides. `cell` is its place, in cells.
  bool may_differ(Vec3i cell, int log2_side) const;

 private:
  WindingField(const QuantizedMesh& mesh, CountedVector<BoundaryEdge> boundary, double threshold,
               Work work);

  bool is_inside(Vec3d point, std::int32_t of_closed) const;

  const QuantizedMesh& mesh_;
  EdgeTree edges_;
  WindingTree caps_;
  double threshold_;
};

/// Returns the Morton codes, in ascending order, of voxels that are not in `cover`, such that all
/// voxels of a connected set of the other voxels that are not in `cover` are inside, or none is.
/// They form sheets over the holes: time and memory grow with the sheets and the boundary. `cover`
/// must be the DAG of the mesh. Throws OverMemory and Cancelled.
PageVector<std::uint64_t> find_sheets(const WindingField& field, const SvdagView& cover, Work work);

}  // namespace voxdag
