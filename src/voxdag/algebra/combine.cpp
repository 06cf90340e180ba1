#include "voxdag/algebra/combine.hpp"

#include <algorithm>
#include <cassert>

#include "voxdag/algebra/source_dag.hpp"

namespace voxdag {
namespace {

/// The nodes of a DAG that have all voxels: at most one per level.
class FullNodes {
 public:
  explicit FullNodes(const SvdagView& dag) {
    std::fill(std::begin(nodes_), std::end(nodes_), kNone);
    const std::uint64_t* end = dag.leaf_blocks + dag.leaf_block_count;
    const std::uint64_t* leaf = std::find(dag.leaf_blocks, end, ~std::uint64_t{0});
    if (leaf == end) return;
    nodes_[dag.levels - 2] = static_cast<std::uint32_t>(leaf - dag.leaf_blocks);
    for (int level = dag.levels - 3; level >= 0 && nodes_[level + 1] != kNone; --level)
      for (std::uint64_t at = dag.level_begin[level]; at < dag.level_begin[level + 1];
           at += 1 + static_cast<std::uint64_t>(popcount(dag.nodes[at])))
        if (dag.nodes[at] == 0xFF && std::all_of(dag.nodes + at + 1, dag.nodes + at + 9,
                                                 [&](auto p) { return p == nodes_[level + 1]; })) {
          nodes_[level] = static_cast<std::uint32_t>(at);
          break;
        }
  }
  bool contains(int level, std::uint32_t node) const { return node == nodes_[level]; }

 private:
  static constexpr std::uint32_t kNone = kNoCell - 1;
  std::uint32_t nodes_[kMaxLevels];
};

/// A key is a node of each DAG. Nodes that cannot change the result become kNoCell, so that fewer
/// keys are different.
class CombineRule {
 public:
  static constexpr std::size_t kWords = 2;
  using Key = std::array<std::uint32_t, kWords>;

  CombineRule(const SvdagView& a, const SvdagView& b, SetOperation operation)
      : a_(a), b_(b), full_a_(a), full_b_(b), operation_(operation) {}

  Key root() const { return simplified(0, {a_.root(), b_.root()}); }
  void children(int level, const Key& key, Key (&keys)[8]) const {
    for (int i = 0; i < 8; ++i)
      keys[i] = simplified(level + 1, {a_.child(level, key[0], i), b_.child(level, key[1], i)});
  }
  std::uint64_t block(const Key& key) const {
    const std::uint64_t a = a_.block(key[0]), b = b_.block(key[1]);
    switch (operation_) {
      case SetOperation::kUnion:
        return a | b;
      case SetOperation::kIntersection:
        return a & b;
      case SetOperation::kDifference:
        return a & ~b;
      default:
        return a ^ b;
    }
  }

 private:
  Key simplified(int level, Key key) const {
    const bool has_a = key[0] != kNoCell, has_b = key[1] != kNoCell;
    switch (operation_) {
      case SetOperation::kUnion:
        if (has_a && has_b && full_a_.contains(level, key[0])) return {key[0], kNoCell};
        if (has_a && has_b && full_b_.contains(level, key[1])) return {kNoCell, key[1]};
        return key;
      case SetOperation::kIntersection:
        return has_a && has_b ? key : empty_key<kWords>();
      case SetOperation::kDifference:
        if (!has_a || full_b_.contains(level, key[1])) return empty_key<kWords>();
        return key;
      default:
        return key;
    }
  }

  SourceDag a_, b_;
  FullNodes full_a_, full_b_;
  SetOperation operation_;
};

}  // namespace

Svdag combine(const SvdagView& a, const SvdagView& b, SetOperation operation, Work work) {
  assert(a.levels == b.levels);
  return rewrite(CombineRule(a, b, operation), a.levels, work);
}

}  // namespace voxdag
