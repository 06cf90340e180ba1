#pragma once
/// Builds the part of an ESVO below one cell, depth first.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 3.4.
///
/// Which voxels exist is exact (design: exact cover); contours enclose the polygons that the
/// triangles leave in a voxel. The colour and normal of a leaf are the means over its polygons,
/// those of another voxel the means over its leaves, by area.
#include <optional>

#include "voxdag/esvo/build/built_voxel.hpp"
#include "voxdag/esvo/build/decide_cell.hpp"
#include "voxdag/esvo/build/piece_stack.hpp"

namespace voxdag {

class SubtreeBuilder {
 public:
  /// Refers to all arguments; those that are not const are scratch memory of the caller's thread.
  SubtreeBuilder(const EsvoSettings& settings, const CellAppearance& appearance,
                 CellDecider& decider, PieceStack& pieces)
      : settings_(settings), appearance_(appearance), decider_(decider), pieces_(pieces) {}

  /// Builds the root cell of the pieces with all that is below it. `decision` is the cell's, and
  /// `shape` what the contours of the cell and its ancestors leave of it.
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
  /// `is_near` is that of the parent's decision.
  Visited visit(StackedCell& cell, bool is_near, ConvexPolyhedron& shape);
  /// `is_near` is that of the cell's own decision.
  Visited visit_children(const StackedCell& cell, bool is_near, const ConvexPolyhedron& shape);
  Visited join(const Visited (&children)[8]);

  const EsvoSettings& settings_;
  const CellAppearance& appearance_;
  CellDecider& decider_;
  PieceStack& pieces_;
  // In reverse order: children before parents, siblings from last to first.
  EsvoTree tree_;
};

}  // namespace voxdag
