#pragma once
/// The scratch memory that each thread needs to decide and build cells.
#include "voxdag/builders/esvo/build/decide_cell.hpp"
#include "voxdag/builders/pieces/piece_stack.hpp"

namespace voxdag {

struct CellScratch {
  CellScratch(const EsvoSettings& settings, const CellAppearance& appearance, MemoryBudget* memory)
      : pieces(memory), decider(settings, appearance) {}

  PieceStack pieces;
  CellDecider decider;
};

}  // namespace voxdag
