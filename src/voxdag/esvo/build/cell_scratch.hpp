#pragma once
/// The scratch memory that each thread needs to decide and build cells.
#include <tbb/task_arena.h>

#include "voxdag/esvo/build/decide_cell.hpp"
#include "voxdag/pieces/piece_stack.hpp"

namespace voxdag {

struct CellScratch {
  CellScratch(const EsvoSettings& settings, const CellAppearance& appearance, MemoryBudget* memory)
      : pieces(memory), decider(settings, appearance) {
    if (memory == nullptr || memory->limit() == 0) return;
    const auto threads = static_cast<std::uint64_t>(tbb::this_task_arena::max_concurrency());
    most_kept_bytes = memory->limit() / 16 / threads;
  }

  /// Frees the memory of the pieces after a cell, if it is much for the budget: the next cell would
  /// fault in each page anew.
  void finish_cell() {
    if (pieces.held_bytes() > most_kept_bytes) pieces.free_memory();
  }

  PieceStack pieces;
  CellDecider decider;
  std::uint64_t most_kept_bytes = ~std::uint64_t{0};  ///< By each thread between two cells.
};

}  // namespace voxdag
