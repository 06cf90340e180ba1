#pragma once
/// The generalised winding number of a mesh at voxels.
///
/// Source: Jacobson, Kavan and Sorkine-Hornung, "Robust Inside-Outside Segmentation using
/// Generalized Winding Numbers", SIGGRAPH 2013. It tells how often the surface winds around a
/// point: a whole number if the mesh is closed, and near one far away from the holes of others.
///
/// The mesh and caps over its holes together are closed. So the winding numbers of mesh and caps
/// differ by a whole number. A rough sum over the clusters of the mesh tells which one, and the
/// caps, which are few, give the rest precisely.
#include "voxdag/solid/winding/edge_tree.hpp"
#include "voxdag/solid/winding/winding_tree.hpp"

namespace voxdag {

class WindingField {
 public:
  /// A voxel is inside if the absolute winding number at its centre is at least `threshold`, which
  /// is positive. All triangles of the mesh must be in range. Throws OverMemory and Cancelled;
  /// `memory` and `progress` may be null.
  WindingField(const QuantizedMesh& mesh, double threshold, MemoryBudget* memory,
               Progress* progress)
      : WindingField(mesh, find_boundary_edges(mesh, memory, progress), threshold, memory,
                     progress) {}

  /// Returns whether a voxel that no triangle meets is inside. Voxels whose winding number is
  /// within 1e-6 of the threshold may be on either side.
  bool is_inside(Vec3i voxel) const;

  /// Returns whether two voxels in a cell of 2^log2_side voxels a side that are connected through
  /// voxels that no triangle meets can be on different sides. `cell` is its place, in cells.
  bool may_differ(Vec3i cell, int log2_side) const;

 private:
  WindingField(const QuantizedMesh& mesh, CountedVector<BoundaryEdge> boundary, double threshold,
               MemoryBudget* memory, Progress* progress);

  EdgeTree edges_;
  WindingTree mesh_, caps_;
  double threshold_;
};

}  // namespace voxdag
