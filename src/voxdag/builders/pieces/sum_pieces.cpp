#include "voxdag/builders/pieces/sum_pieces.hpp"

#include <algorithm>

namespace voxdag {

void add_piece(SurfaceSum& sum, const Cell& cell, const TrianglePiece& piece,
               const SurfaceSample& sample) {
  // A triangle that only touches the cell has a small weight, so that every voxel has a colour. An
  // almost transparent piece has a small weight too, because part of it may pass the alpha test.
  const float area = static_cast<float>(cell.area(piece) + 1e-6) * std::max(sample.coverage, 1e-3f);
  sum.add(sample.color, sample.normal, area);
}

SurfaceSum sum_pieces(const Cell& cell, const PieceSampler& sampler) {
  SurfaceSum sum;
  for (const TrianglePiece& piece : cell.pieces)
    add_piece(sum, cell, piece, sampler.sample(cell, piece));
  return sum;
}

}  // namespace voxdag
