#pragma once
/// The node layout for rays at the paper's SVDAG (stored/svdag/svdag.hpp).
///
/// A node layout for cast() is a type with
///   using Node          what the stack stores for a node; small and trivially copyable
///   is_empty()          no voxels at all
///   levels()            L
///   root()              the node of level 0; not called on an empty DAG
///   child_mask(n, l)    the 8-bit child mask of node n of level l
///   child(n, l, i)      child i, which is present, of node n of level l < L-1
/// Children of nodes of level L-1 are voxels: a bit in the mask and nothing else. A layout may also
/// have on_step(), called at each step of a walk: see render/count_steps.hpp; and Path: see
/// cell_walk.hpp.
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

class SvdagPath;

/// A node is a word index (level < L-2), the index of a leaf block (level L-2), or its own child
/// mask, a byte of a leaf block (level L-1).
class SvdagNodes {
 public:
  using Node = std::uint32_t;
  /// Reads the words by itself: a derived layout with its own child() needs its own Path, too.
  using Path = SvdagPath;

  VOXDAG_HD explicit SvdagNodes(const SvdagView& dag)
      : nodes_(dag.nodes),
        leaf_blocks_(dag.leaf_blocks),
        levels_(dag.levels),
        is_empty_(dag.is_empty()),
        view_(dag) {}

  VOXDAG_HD const SvdagView& view() const { return view_; }

  VOXDAG_HD bool is_empty() const { return is_empty_; }
  VOXDAG_HD int levels() const { return levels_; }
  VOXDAG_HD Node root() const { return view_.root; }

  VOXDAG_HD std::uint32_t child_mask(Node node, int level) const {
    if (level < levels_ - 2) return voxdag::child_mask(nodes_ + node);
    if (level == levels_ - 1) return node;
    return leaf_block_child_mask(leaf_blocks_[node]);
  }

  /// Returns the address that child_mask() and block() will read; `level` is at most L-2.
  VOXDAG_HD const void* address(Node node, int level) const {
    if (level < levels_ - 2) return nodes_ + node;
    return leaf_blocks_ + node;
  }

  /// Returns the mask of the 4³ voxels of `node`, of level L-2.
  VOXDAG_HD std::uint64_t block(Node node) const { return leaf_blocks_[node]; }

  VOXDAG_HD Node child(Node node, int level, int index) const {
    if (level < levels_ - 2) return child_pointer(nodes_ + node, index);
    return static_cast<Node>(leaf_blocks_[node] >> (8 * index) & 0xFFu);
  }

 private:
  const std::uint32_t* nodes_;
  const std::uint64_t* leaf_blocks_;
  int levels_;
  bool is_empty_;
  SvdagView view_;
};

/// A NodePath with fewer instructions, which are what limits GPUs: the stack holds child masks, and
/// a walk reads a leaf block once.
class SvdagPath {
 public:
  struct Entry {
    std::uint32_t node, mask;
  };

  SvdagPath() = default;
  VOXDAG_HD explicit SvdagPath(const SvdagNodes& layout)
      : nodes_(layout.view().nodes),
        leaf_blocks_(layout.view().leaf_blocks),
        leaf_level_(layout.levels() - 2),
        node_(layout.root()),
        mask_(layout.child_mask(layout.root(), 0)),
        block_mask_(mask_) {
    if (leaf_level_ == 0) block_ = leaf_blocks_[node_];
  }

  VOXDAG_HD std::uint32_t mask() const { return mask_; }
  /// Starts again at `node` of `level` <= L-2.
  VOXDAG_HD void start(std::uint32_t node, int level) {
    node_ = node;
    if (level == leaf_level_) {
      block_ = leaf_blocks_[node_];
      mask_ = block_mask_ = leaf_block_child_mask(block_);
    } else {
      mask_ = child_mask(nodes_ + node_);
    }
  }
  VOXDAG_HD void push(Entry* stack, int level, std::uint32_t index) {
    if (level > leaf_level_) {
      mask_ = static_cast<std::uint32_t>(block_ >> (8 * index)) & 0xFFu;
      return;
    }
    stack[level - 1] = {node_, mask_};
    start(nodes_[node_ + 1 + popcount8(mask_ & ((1u << index) - 1u))], level);
  }
  VOXDAG_HD void pop(const Entry* stack, int level) {
    if (level > leaf_level_) {
      mask_ = block_mask_;  // the walk was in a byte of the block
      return;
    }
    node_ = stack[level - 1].node;
    mask_ = stack[level - 1].mask;
  }

 private:
  const std::uint32_t* nodes_ = nullptr;
  const std::uint64_t* leaf_blocks_ = nullptr;
  int leaf_level_ = 0;  ///< L-2
  std::uint32_t node_ = 0, mask_ = 0;
  /// The last leaf block that the walk was in.
  std::uint64_t block_ = 0;
  std::uint32_t block_mask_ = 0;
};

}  // namespace voxdag
