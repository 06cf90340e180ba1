#pragma once
/// Decides the contour of a cell and whether it is a leaf.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 3.4, a greedy
/// method from the top down. The shape of a cell is its cube, cut by the contours of its ancestors.
/// The cell gets the contour that removes most of the part of its shape that lies beyond the
/// surface. The cell is a leaf if its shape is near enough to the surface and its colours and
/// normals are uniform enough.
#include <optional>
#include <vector>

#include "voxdag/builders/esvo/build/cell_appearance.hpp"
#include "voxdag/builders/esvo/shape/convex_polyhedron.hpp"
#include "voxdag/builders/esvo/shape/fit_contour.hpp"
#include "voxdag/builders/esvo/shape/near_surface.hpp"
#include "voxdag/builders/pieces/piece_stack.hpp"
#include "voxdag/stored/esvo/contour.hpp"

namespace voxdag {

/// The decisions about a cell, made before its children are built.
struct CellDecision {
  bool is_leaf = false;
  bool is_near = false;  ///< Near enough to the surface: no contours below.
  std::optional<Contour> contour;
};

/// If a cell has very many pieces, each n-th of them is looked at for directions; returns n. These
/// about 48 pieces have all directions that matter.
constexpr std::size_t candidate_step(std::size_t pieces) { return (pieces + 47) / 48; }

/// Collects the candidate directions for the cell's contour: the normals of its triangles, and the
/// perpendiculars of open edges in the triangles' planes.
ContourCandidates contour_candidates(const Cell& cell);

/// Decides one cell after the other. Each thread needs its own, because it keeps scratch memory.
class CellDecider {
 public:
  /// Refers to both arguments.
  CellDecider(const EsvoSettings& settings, const CellAppearance& appearance)
      : settings_(settings), appearance_(appearance) {}

  /// Decides a cell with at least one piece. `is_near` is the CellDecision::is_near of the cell's
  /// parent. Cuts `shape` by the cell's contour. If the cell is a leaf, `sum` becomes its
  /// appearance.
  CellDecision decide(const Cell& cell, bool is_near, ConvexPolyhedron& shape, SurfaceSum& sum);

  /// Returns true only if no voxel of half the cell's side can have a useful contour, because the
  /// shape is too thin in every direction that the contour could have.
  static bool is_too_thin(const Cell& cell, const ConvexPolyhedron& shape);

 private:
  void fit(const Cell& cell, ConvexPolyhedron& shape, CellDecision& decision);

  const EsvoSettings& settings_;
  const CellAppearance& appearance_;
  std::vector<PlanarPolygon> polygons_;  // The polygons of the current cell.
};

/// The scratch memory that each thread needs to decide and build cells.
struct CellScratch {
  CellScratch(const EsvoSettings& settings, const CellAppearance& appearance, MemoryBudget* memory)
      : pieces(memory), decider(settings, appearance) {}

  PieceStack pieces;
  CellDecider decider;
};

}  // namespace voxdag
