#pragma once
/// How fast a winding number can change, from the boundary of the surface.
#include "voxdag/builders/solid/winding/boundary_edges.hpp"
#include "voxdag/core/page_vector.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

/// Away from a surface, the gradient of its winding number follows from the boundary alone, as a
/// magnetic field does from its currents (the law of Biot and Savart). Across the surface, the
/// winding number changes by a whole number and its gradient does not change.
class EdgeTree {
 public:
  /// Throws OverMemory and Cancelled.
  EdgeTree(const CountedVector<BoundaryEdge>& boundary, Work work);

  bool is_empty() const { return edges_.empty(); }
  /// Returns a bound on the length of the gradient, per 1/256 voxel, in the ball of `radius` around
  /// `centre`, in units of 1/256 voxel. It may stop at any value above `enough`; infinite if an
  /// edge reaches into the ball.
  double steepest(Vec3d centre, double radius, double enough) const;

 private:
  /// A cluster of edges: node i + 1 is its first half, if it is not a leaf.
  struct Node {
    Vec3d centre;
    double radius;               ///< All edges lie in this ball.
    double length;               ///< Of all edges, over 4 pi.
    std::uint32_t next;          ///< The node after this subtree.
    std::uint32_t first, count;  ///< A leaf's edges; no count: no leaf.
  };
  /// A box and a length.
  struct Extent {
    Vec3d lo, hi;
    double length = 0;
  };

  Extent add_node(std::size_t first, std::size_t count);

  PageVector<BoundaryEdge> edges_;
  PageVector<Node> nodes_;
};

}  // namespace voxdag
