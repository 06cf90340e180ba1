#pragma once
/// Decides the contours of cells whose surface is not loaded: cells with too many triangles, and
/// cells too large to tessellate their displaced triangles.
///
/// The triangles pass by one after the other, first to choose the directions and again to measure
/// the surface along them. So the memory does not depend on their number.
#include <cstdint>
#include <span>

#include "voxdag/builders/esvo/build/decide_cell.hpp"
#include "voxdag/builders/esvo/shape/fit_contour.hpp"
#include "voxdag/builders/pieces/triangle_source.hpp"

namespace voxdag {

/// Returns the normals of the triangles before displacement. If there are very many triangles,
/// looks at about 16,000 of them.
ContourCandidates enclosed_candidates(const TriangleSource& source, int level, Vec3i cell,
                                      std::span<const std::uint32_t> triangles);

/// Decides the contour of a cell from what encloses its displaced triangles (pieces of them, at
/// most an eighth of the cell wide) and from its other triangles. Without displaced triangles, the
/// contour equals the one that CellDecider fits to the loaded cell. The decision is never a leaf.
/// `shape` is what the ancestors' contours leave of the cell; it is cut by the new contour. Runs in
/// parallel.
CellDecision decide_enclosed(const TriangleSource& source, int level, Vec3i cell,
                             std::span<const std::uint32_t> triangles,
                             const ContourCandidates& candidates, ConvexPolyhedron& shape);

}  // namespace voxdag
