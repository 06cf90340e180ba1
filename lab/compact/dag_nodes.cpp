#include "lab/compact/dag_nodes.hpp"

namespace voxdag::lab {

DagNodes list_nodes(const SvdagView& dag) {
  DagNodes list;
  list.leaf_blocks.assign(dag.leaf_blocks, dag.leaf_blocks + dag.leaf_block_count);
  list.nodes.resize(dag.levels - 2);
  // A node has at least two words, so half of its offset is its own: below[offset / 2] is the index
  // of the node of the level below.
  std::vector<std::uint32_t> below;
  for (int level = dag.levels - 3; level >= 0; --level) {
    const std::uint64_t begin = dag.level_begin[level], end = dag.level_begin[level + 1];
    std::vector<std::uint32_t> index((end - begin) / 2 + 1, kNoNode);
    for (std::uint64_t at = begin; at < end; at += 1 + popcount8(child_mask(dag.nodes + at))) {
      const std::uint32_t* node = dag.nodes + at;
      index[(at - begin) / 2] = static_cast<std::uint32_t>(list.nodes[level].size());
      DagNodes::Node& children = list.nodes[level].emplace_back();
      for (int octant = 0; octant < 8; ++octant) {
        children[octant] = kNoNode;
        if (((child_mask(node) >> octant) & 1) == 0) continue;
        const std::uint32_t pointer = child_pointer(node, octant);
        children[octant] = level == dag.levels - 3 ? pointer : below[(pointer - end) / 2];
      }
    }
    below.swap(index);
  }
  return list;
}

}  // namespace voxdag::lab
