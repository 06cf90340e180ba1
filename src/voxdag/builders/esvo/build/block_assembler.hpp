#pragma once
/// Collects finished tasks in order. Large trees go to the sink as blocks; small ones join the tree
/// of the parent cell.
#include <vector>

#include "voxdag/builders/esvo/build/build_esvo.hpp"
#include "voxdag/builders/esvo/build/top_cells.hpp"

namespace voxdag {

/// A finished task.
struct FinishedTask {
  std::size_t cell = 0;  ///< Index of the task among the top cells.
  BuiltVoxel voxel;
  bool has_blocks = false;
  PackedBlocks blocks;  ///< Everything below the voxel, if has_blocks.
  MemoryReservation block_memory;
};

/// Returns whether a tree is large enough for blocks of its own.
bool needs_blocks(const EsvoTree& tree);

class BlockAssembler {
 public:
  /// Refers to its arguments, and finishes the cells.
  BlockAssembler(TopCells& cells, const EsvoOptions& options, EsvoSink& sink, MemoryBudget* memory)
      : cells_(cells), options_(options), sink_(sink), memory_(memory) {}

  /// Takes the tasks in Morton order.
  void add(FinishedTask& task);

  /// Appends the block of the root after the last task.
  EsvoResult finish();

 private:
  std::uint64_t append(const PackedBlocks& blocks);
  void arrive(std::size_t cell, BuiltVoxel&& voxel);

  TopCells& cells_;
  const EsvoOptions& options_;
  EsvoSink& sink_;
  MemoryBudget* const memory_;
  std::uint64_t position_ = 0;
  EsvoResult result_;
  BuiltVoxel root_;
};

}  // namespace voxdag
