#include "voxdag/formats/exports/full_nodes.hpp"

namespace voxdag {

FullNodes::FullNodes(const SvdagView& dag) : dag_(dag), full_(dag.node_words()) {
  // Go from the lowest level up: a node is full if its eight children are.
  for (int level = dag.levels - 3; level >= 0; --level)
    for_each_node(dag, level, [&](std::uint64_t at) {
      const std::uint32_t* const node = dag.nodes + at;
      bool full = child_mask(node) == 0xFF;
      for (int i = 1; full && i <= 8; ++i) full = is_full(level + 1, node[i]);
      full_[at] = full;
    });
}

}  // namespace voxdag
