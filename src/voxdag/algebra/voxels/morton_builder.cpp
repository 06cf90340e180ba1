#include "voxdag/algebra/voxels/morton_builder.hpp"

#include "voxdag/algebra/rewrite.hpp"

namespace voxdag {

MortonBuilder::MortonBuilder(int levels, MemoryBudget* memory) : levels_(levels), memory_(memory) {
  for (int level = 0; level <= levels - 2; ++level) nodes_.emplace_back(memory);
  open_.resize(static_cast<std::size_t>(levels - 2));
}

Svdag MortonBuilder::finish() {
  if (block_ == 0) {
    Svdag empty;
    empty.levels = levels_;
    return empty;
  }
  // No block follows: all nodes are complete.
  close_block(~std::uint64_t{0});
  return detail::join_levels(levels_, nodes_, memory_);
}

/// Adds the block, and all nodes that have no child at or after the block `next`.
void MortonBuilder::close_block(std::uint64_t next) {
  const std::uint32_t words[] = {static_cast<std::uint32_t>(block_),
                                 static_cast<std::uint32_t>(block_ >> 32)};
  std::uint32_t place = nodes_.back().add(words, 2);
  block_ = 0;
  for (int level = levels_ - 3; level >= 0; --level) {
    const int below = 3 * (levels_ - 3 - level);
    Node& node = open_[static_cast<std::size_t>(level)];
    node.words[0] |= 1u << (block_code_ >> below & 7);
    node.words[node.size++] = place;
    if (block_code_ >> (below + 3) == next >> (below + 3)) return;
    place = nodes_[static_cast<std::size_t>(level)].add(node.words.data(), node.size);
    node = {};
  }
}

}  // namespace voxdag
