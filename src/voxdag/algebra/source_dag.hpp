#pragma once
/// A DAG as a source of rules.
#include "voxdag/algebra/rewrite.hpp"

namespace voxdag {

/// A DAG of L levels, seen as the corner at (0,0,0) of a grid of `levels` >= L levels.
class SourceDag {
 public:
  explicit SourceDag(const SvdagView& dag) : SourceDag(dag, dag.levels) {}
  SourceDag(const SvdagView& dag, int levels) : dag_(dag), above_(levels - dag.levels) {}

  std::uint32_t root() const {
    if (dag_.is_empty()) return kNoCell;
    return above_ > 0 ? kAboveRoot : dag_.root;
  }
  /// Returns child `index` of a node of `level`, which is below levels - 2; kNoCell if there is
  /// none, or if `node` is kNoCell.
  std::uint32_t child(int level, std::uint32_t node, int index) const {
    if (node == kNoCell) return kNoCell;
    if (node == kAboveRoot) {
      if (index != 0) return kNoCell;
      return level + 1 == above_ ? dag_.root : kAboveRoot;
    }
    const std::uint32_t* words = dag_.nodes + node;
    return (child_mask(words) >> index & 1) != 0 ? child_pointer(words, index) : kNoCell;
  }
  /// Prefetches what child() reads.
  void prefetch(std::uint32_t node) const {
    if (node >= kAboveRoot) return;
    __builtin_prefetch(dag_.nodes + node);
    __builtin_prefetch(dag_.nodes + node + 8);  // its last word may lie in the next line
  }
  /// Returns the voxels of a node of level levels - 2; none if `node` is kNoCell. A DAG has at
  /// least two levels, so the node is never above its root.
  std::uint64_t block(std::uint32_t node) const {
    return node == kNoCell ? 0 : dag_.leaf_blocks[node];
  }
  const SvdagView& view() const { return dag_; }

  // A node as the words of a key, for rules that also take a LongSourceDag.
  using Key = std::array<std::uint32_t, 1>;
  Key root_key() const { return {root()}; }
  Key child_key(int level, const Key& node, int index) const {
    return {child(level, node[0], index)};
  }
  std::uint64_t block(const Key& node) const { return block(node[0]); }
  /// Returns the child mask of a node of `level` of a DAG without levels above its root.
  std::uint32_t mask(int level, const Key& node) const {
    return level == dag_.levels - 2 ? leaf_block_child_mask(dag_.leaf_blocks[node[0]])
                                    : child_mask(dag_.nodes + node[0]);
  }
  int levels() const { return dag_.levels; }

 private:
  static constexpr std::uint32_t kAboveRoot = kNoCell - 1;

  SvdagView dag_;
  int above_;  ///< Levels above the DAG's root.
};

}  // namespace voxdag
