#pragma once
/// Builds a DAG from voxels in Morton order.
#include <array>
#include <cstdint>
#include <vector>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/stored/svdag/svdag.hpp"
#include "voxdag/stored/svdag/unique_cells.hpp"

namespace voxdag {

/// Joins voxels to a DAG node by node. It holds the DAG and the unfinished nodes of one path.
class MortonBuilder {
 public:
  /// A grid of 2^levels voxels a side.
  MortonBuilder(int levels, MemoryBudget* memory);

  /// Adds the voxel of a Morton code. Codes do not descend. Throws Error if the DAG outgrows 32-bit
  /// pointers, and OverMemory.
  void add(std::uint64_t code) {
    if (block_ != 0 && code >> 6 != block_code_) close_block(code >> 6);
    block_code_ = code >> 6;
    block_ |= std::uint64_t{1} << (code & 63);
  }
  /// Adds the voxels of a leaf block, at least one. `code` is the block's, code >> 6 of its voxels;
  /// it is after those that came before. Throws as add() does.
  void add_block(std::uint64_t code, std::uint64_t voxels) {
    if (block_ != 0) close_block(code);
    block_code_ = code;
    block_ = voxels;
  }
  /// Returns the minimal DAG, in canonical order. Call it last. Throws as add() does.
  Svdag finish();

 private:
  /// The words of a node, as UniqueNodes has them.
  struct Node {
    std::array<std::uint32_t, 9> words{};
    std::size_t size = 1;
  };

  void close_block(std::uint64_t next);

  int levels_;
  MemoryBudget* memory_;
  std::vector<UniqueNodes> nodes_;
  std::vector<Node> open_;
  std::uint64_t block_ = 0, block_code_ = 0;
};

}  // namespace voxdag
