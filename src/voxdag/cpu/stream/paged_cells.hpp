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
    return node.is_full ? 0xFFu : descriptor(node, level, false).valid_mask();
  }
  Node child(const Node& node, int level, int index) const {
    return {node.cell * 2 + child_offset(index),
            node.is_full || (descriptor(node, level, true).leaf_mask() >> index & 1u) != 0};
  }

 private:
  /// Returns the descriptor of a node that is not full. If the block of its children is missing,
  /// the descriptor marks all children as leaves, unless `with_children` loads the block.
  ChildDescriptor descriptor(const Node& node, int level, bool with_children) const {
    std::uint64_t slot = source_->view().root;
    for (int l = 0;;) {
      const std::int64_t block = source_->loaded().missing_block(slot);
      if (block >= 0 && (l < level || with_children)) {
        source_->load(static_cast<std::size_t>(block));
        slot = source_->view().root;
        l = 0;
        continue;
      }
      const EsvoView esvo = source_->view();
      const ChildDescriptor descriptor = esvo.descriptor(slot);
      if (l == level) return descriptor;
      ++l;
      slot = esvo.child(slot, descriptor, child_index(node.cell, level - l));
    }
  }

  BlockSource* source_;
};

}  // namespace voxdag
