#pragma once
/// Walks any compact DAG, broken ones too.
#include "voxdag/stored/compact/compact_nodes.hpp"

namespace voxdag {

/// Reads nodes depth first, `left` of them at most. Returns whether all their ranges lie in the
/// stream.
inline bool ranges_are_safe(const CompactSvdagView& dag, CompactRange range, int level, int& left) {
  if (left-- <= 0) return true;
  if (range.begin > range.end || range.end > dag.stream_bits) return false;
  if (level == dag.coded_levels() - 4) {
    CompactUnit unit;
    read_unit(dag, range, unit);
    return true;
  }
  CompactNode node;
  read_node(dag, range, level, node);
  for (int i = 0; i < 8; ++i)
    if ((node.mask >> i & 1) != 0 && !ranges_are_safe(dag, node.children[i], level + 1, left))
      return false;
  return true;
}

inline bool ranges_are_safe(const CompactSvdagView& dag, int most_nodes) {
  return dag.is_empty() || ranges_are_safe(dag, root_node(dag), 0, most_nodes);
}

}  // namespace voxdag
