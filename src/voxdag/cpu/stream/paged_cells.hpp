#pragma once
/// The node layout for walks of the upper levels of an ESVO that has only a few blocks in memory.
#include <cstdint>

#include "voxdag/core/morton.hpp"
#include "voxdag/cpu/stream/streamed_image.hpp"

namespace voxdag {

/// A node layout (trace/svdag_nodes.hpp) that loads the blocks that a walk reaches. Its nodes are
/// cells. Each access looks the cell up from the root, because blocks move. For one thread.
class PagedCells {
 public:
  struct Node {
    Vec3i cell;
    bool is_full = false;  ///< Inside of a leaf.
  };

  explicit PagedCells(BlockSource& source) : source_(&source) {}

  bool is_empty() const { return source_->view().is_empty(); }
  int levels() const { return source_->view().levels; }
  Node root() const { return {}; }

  std::uint32_t child_mask(const Node& node, int level) const {
    return node.is_full ? 0xFFu : descriptor_at(find(node.cell, level)).valid_mask();
  }
  Node child(const Node& node, int level, int index) const {
    const bool is_full = node.is_full || is_leaf(node.cell, level, index);
    return {node.cell * 2 + child_offset(index), is_full};
  }

 private:
  /// Returns the slot of a cell that is a node. Loads the blocks on the way to it.
  std::uint64_t find(Vec3i cell, int level) const {
    std::uint64_t slot = source_->view().root;
    for (int l = 1; l <= level; ++l) {
      if (load_children(slot)) return find(cell, level);  // All slots may have moved.
      slot = source_->view().child(slot, descriptor_at(slot), child_index(cell, level - l));
    }
    return slot;
  }

  /// Returns whether a child of a node is a leaf. Loads its block if it is not: without the block,
  /// the node's descriptor marks all its children as leaves.
  bool is_leaf(Vec3i cell, int level, int index) const {
    std::uint64_t slot;
    do slot = find(cell, level);
    while (load_children(slot));
    return (descriptor_at(slot).leaf_mask() >> index & 1u) != 0;
  }

  /// Loads the block of the children of the node in a slot. Returns false if it was loaded already.
  bool load_children(std::uint64_t slot) const {
    const std::int64_t block = source_->loaded().missing_block(slot);
    if (block >= 0) source_->load(static_cast<std::size_t>(block));
    return block >= 0;
  }

  ChildDescriptor descriptor_at(std::uint64_t slot) const {
    return source_->view().descriptor(slot);
  }

  BlockSource* source_;
};

}  // namespace voxdag
