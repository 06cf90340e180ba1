#pragma once
/// The node layout for single rays at an InPlaceDag.
#include "voxdag/cpu/packets/in_place_dag.hpp"

namespace voxdag {

/// See trace/svdag_nodes.hpp for the members. One thread uses an object, with its own cache. Nodes
/// below a unit are valid until the cast reaches another unit.
class InPlaceNodes {
 public:
  using Node = std::uint32_t;

  InPlaceNodes(const InPlaceDag& dag, UnitCache& cache)
      : dag_(&dag),
        cache_(&cache),
        words_(dag.words()),
        levels_(dag.levels()),
        unit_level_(dag.unit_level()) {}

  bool is_empty() const { return dag_->is_empty(); }
  int levels() const { return levels_; }
  Node root() const { return 0; }

  std::uint32_t child_mask(Node node, int level) const {
    const int below = level - unit_level_;
    if (below < 0) return words_[2 * std::size_t{node}];
    if (below == 0) {
      unit_ = &cache_->unit(*dag_, node);
      return unit_->words[0];
    }
    if (below == 1) return unit_->words[2 * node];
    if (below == 2) return leaf_block_child_mask(unit_->leaf_blocks[node]);
    return node;
  }
  Node child(Node node, int level, int index) const {
    const auto octant = static_cast<std::uint32_t>(index);
    const int below = level - unit_level_;
    if (below < 0) return bounded_node_child(words_ + 2 * std::size_t{node}, octant);
    if (below == 0) {
      unit_ = &cache_->unit(*dag_, node);
      return bounded_node_child(unit_->words, octant);
    }
    if (below == 1) return bounded_node_child(unit_->words + 2 * node, octant);
    return static_cast<Node>(unit_->leaf_blocks[node] >> (8 * index) & 0xFFu);
  }

 private:
  const InPlaceDag* dag_;
  UnitCache* cache_;
  const std::uint32_t* words_;
  int levels_, unit_level_;
  mutable const DecodedUnit* unit_ = nullptr;  ///< The unit that the walk reached last.
};

}  // namespace voxdag
