#pragma once
/// A DAG with long pointers as a source of rules.
#include "voxdag/algebra/rewrite.hpp"
#include "voxdag/stored/svdag/long_svdag.hpp"

namespace voxdag {

/// Has the functions of SourceDag for nodes as keys. A node is its place: the word in its level, or
/// the leaf block.
class LongSourceDag {
 public:
  using Key = std::array<std::uint32_t, 2>;

  explicit LongSourceDag(const LongSvdagView& dag) : dag_(dag) {}

  Key root_key() const { return dag_.is_empty() ? empty_key<2>() : Key{0, 0}; }
  Key child_key(int level, const Key& node, int index) const {
    if (node == empty_key<2>() || (mask(level, node) >> index & 1) == 0) return empty_key<2>();
    const std::uint64_t place = child_place(dag_, level, place_of(node), index);
    return {static_cast<std::uint32_t>(place), static_cast<std::uint32_t>(place >> 32)};
  }
  std::uint64_t block(const Key& node) const {
    return node == empty_key<2>() ? 0 : dag_.leaf_blocks[place_of(node)];
  }
  std::uint32_t mask(int level, const Key& node) const {
    return level == dag_.levels - 2
               ? leaf_block_child_mask(dag_.leaf_blocks[place_of(node)])
               : child_mask(dag_.nodes + dag_.level_begin[level] + place_of(node));
  }
  int levels() const { return dag_.levels; }

 private:
  static std::uint64_t place_of(const Key& node) { return node[0] | std::uint64_t{node[1]} << 32; }

  LongSvdagView dag_;
};

}  // namespace voxdag
