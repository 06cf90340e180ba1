#pragma once
/// The node layout for rays at the paper's SVDAG (layout/svdag.hpp).
///
/// A node layout for cast() is a type with
///   using Node          what the stack stores for a node; small and trivially copyable
///   is_empty()          no voxels at all
///   levels()            L
///   root()              the node of level 0; not called on an empty DAG
///   child_mask(n, l)    the 8-bit child mask of node n of level l
///   child(n, l, i)      child i, which is present, of node n of level l < L-1
/// Children of nodes of level L-1 are voxels: a bit in the mask and nothing else. A layout may also
/// have on_step(), called at each step of a walk: see counting_nodes.hpp.
#include "voxdag/layout/svdag.hpp"

namespace voxdag {

/// A node is a word index (level < L-2), the index of a leaf block (level L-2), or its own child
/// mask, a byte of a leaf block (level L-1).
class SvdagNodes {
 public:
  using Node = std::uint32_t;

  VOXDAG_HD explicit SvdagNodes(const SvdagView& dag)
      : nodes_(dag.nodes),
        leaf_blocks_(dag.leaf_blocks),
        levels_(dag.levels),
        is_empty_(dag.is_empty()),
        view_(dag) {}

  VOXDAG_HD const SvdagView& view() const { return view_; }

  VOXDAG_HD bool is_empty() const { return is_empty_; }
  VOXDAG_HD int levels() const { return levels_; }
  VOXDAG_HD Node root() const { return 0; }

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

}  // namespace voxdag
