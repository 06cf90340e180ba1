#pragma once
/// The appearance of a cell: the sum over the pieces of triangles in it.
#include "voxdag/builders/pieces/piece_sampler.hpp"
#include "voxdag/builders/pieces/surface_sum.hpp"

namespace voxdag {

/// Adds a piece of the cell to the sum. `sample` is the piece's mean appearance.
void add_piece(SurfaceSum& sum, const Cell& cell, const TrianglePiece& piece,
               const SurfaceSample& sample);

/// Sums the colours and normals of all pieces in the cell.
SurfaceSum sum_pieces(const Cell& cell, const PieceSampler& sampler);

}  // namespace voxdag
