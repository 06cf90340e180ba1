#pragma once
/// Decides the contour of a cell and whether it is a leaf.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 3.4, which is
/// greedy from the top down: a cell gets the contour that removes most of the part of its shape
/// that lies beyond the surface, where the shape is what the ancestors' contours leave of the
/// cell. A cell is a leaf if its shape is near enough to the surface and its colours and normals
/// are uniform enough.
#include <optional>
#include <vector>

#include "voxdag/esvo/build/cell_appearance.hpp"
#include "voxdag/esvo/shape/convex_polyhedron.hpp"
#include "voxdag/esvo/shape/near_surface.hpp"
#include "voxdag/layout/contour.hpp"

namespace voxdag {

/// What is decided about a cell before its children are built.
struct CellDecision {
  bool is_leaf = false;
  bool is_near = false;  ///< The shape is near enough to the surface: no contours below this cell.
  std::optional<Contour> contour;
};

/// Decides one cell after the other. One for each thread: it keeps scratch memory.
class CellDecider {
 public:
  /// Refers to both arguments.
  CellDecider(const EsvoSettings& settings, const CellAppearance& appearance)
      : settings_(settings), appearance_(appearance) {}

  /// Decides a cell with at least one piece. `is_near` is that of the cell's parent. Cuts `shape`
  /// by the cell's contour. If the cell is a leaf, `sum` becomes its appearance.
  CellDecision decide(const Cell& cell, bool is_near, ConvexPolyhedron& shape, SurfaceSum& sum);

  /// Returns true only if no voxel of half the cell's side can have a contour that pays, because
  /// the shape is too thin across every direction that the contour might have.
  static bool is_too_thin(const Cell& cell, const ConvexPolyhedron& shape);

 private:
  void fit(const Cell& cell, ConvexPolyhedron& shape, CellDecision& decision);

  const EsvoSettings& settings_;
  const CellAppearance& appearance_;
  std::vector<PlanarPolygon> polygons_;  // of the cell in hand
};

}  // namespace voxdag
