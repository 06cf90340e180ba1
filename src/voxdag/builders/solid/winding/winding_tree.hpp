#pragma once
/// The winding number of triangles around points, by a hierarchy of clusters.
///
/// Source: Barill, Dickson, Schmidt, Levin and Jacobson, "Fast Winding Numbers for Soups and
/// Clouds", SIGGRAPH 2018. A cluster far away counts as the first two terms of its expansion there.
/// Unlike there, a bound on the rest decides how far is far enough, so results have known errors.
#include <cstdint>

#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/page_vector.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

/// A winding number, and the greatest error that it can have.
struct WindingValue {
  double value = 0, error = 0;
};

class WindingTree {
 public:
  /// Holds about 80 bytes per triangle, and 90 while it sorts. Throws OverMemory and Cancelled.
  WindingTree(PageVector<QuantizedTriangle> triangles, Work work);

  /// Returns the sum of the solid angles of all triangles, seen from `point` in units of 1/256
  /// voxel, over 4 pi. The error is at most `tolerance` times 1 and the part of the sphere around
  /// the point that the triangles would cover if they all faced it; 0: sums all triangles. A point
  /// on the surface is on either side of it.
  WindingValue around(Vec3d point, double tolerance) const;

  const PageVector<QuantizedTriangle>& triangles() const { return triangles_; }

 private:
  /// A cluster of triangles: node i + 1 is its first half, if it is not a leaf.
  struct Node {
    Vec3d centre;        ///< Of the area.
    Vec3d dipole;        ///< Sum of area times normal, over 4 pi.
    double moments[6];   ///< xx, yy, zz, xy, xz, yz of the sum of dipole times place, symmetric.
    double spread;       ///< Bounds the error: times 1 / distance⁴.
    double area;         ///< Over 4 pi.
    double share;        ///< Of the area of all triangles.
    double radius;       ///< All triangles are so near to the centre.
    std::uint32_t next;  ///< The node after this subtree.
    std::uint32_t first, count;  ///< A leaf's triangles; no count: no leaf.
  };
  struct Sums;

  Sums add_node(std::size_t first, std::size_t count);
  Sums add_leaf(std::uint32_t node, std::size_t first, std::size_t count);

  PageVector<QuantizedTriangle> triangles_;
  PageVector<Node> nodes_;
};

}  // namespace voxdag
