#pragma once
/// Builds the part of an ESVO below one cell, depth first.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 3.4.
///
/// The set of voxels is exact (see "Exact cover" in the design). Contours enclose the parts of
/// triangles in a voxel. The colour and normal of a leaf are the means over its polygons; those of
/// an inner voxel are the means over its leaves, weighted by area.
#include <optional>

#include "voxdag/builders/esvo/build/built_voxel.hpp"
#include "voxdag/builders/esvo/build/decide_cell.hpp"
#include "voxdag/builders/pieces/piece_stack.hpp"

namespace voxdag {

class SubtreeBuilder {
 public:
  /// Refers to all arguments. Arguments that are not const are scratch memory of the caller's
  /// thread.
  SubtreeBuilder(const EsvoSettings& settings, const CellAppearance& appearance,
                 CellDecider& decider, PieceStack& pieces)
      : settings_(settings), appearance_(appearance), decider_(decider), pieces_(pieces) {}

  /// Builds the root cell of the pieces and everything below it. `decision` is the cell's decision.
  /// `shape` is the cell, cut by its own contour and those of its ancestors.
  BuiltVoxel build(const CellDecision& decision, const ConvexPolyhedron& shape);

 private:
  /// A voxel whose children are built, and the node that lists them.
  struct Visited {
    bool exists = false, is_leaf = false;
    std::optional<Contour> contour;
    SurfaceSum sum;
    EsvoNode node;
  };

  void remove_alpha_masked(StackedCell& cell);
  /// Visits a cell. `is_near` is from the parent's decision.
  Visited visit(StackedCell& cell, bool is_near, ConvexPolyhedron& shape);
  /// Visits the children of a cell. `is_near` is from the cell's own decision.
  Visited visit_children(const StackedCell& cell, bool is_near, const ConvexPolyhedron& shape);
  Visited join(const Visited (&children)[8]);

  const EsvoSettings& settings_;
  const CellAppearance& appearance_;
  CellDecider& decider_;
  PieceStack& pieces_;
  // Nodes are in reverse order: children before parents, siblings from last to first.
  EsvoTree tree_;
};

}  // namespace voxdag
