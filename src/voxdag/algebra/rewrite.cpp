#include "voxdag/algebra/rewrite.hpp"

namespace voxdag::detail {

Svdag join_levels(int levels, const std::vector<UniqueNodes>& nodes, MemoryBudget* memory) {
  Svdag dag;
  dag.levels = levels;
  std::uint64_t total = 0;
  for (int level = 0; level < levels - 2; ++level)
    total += nodes[static_cast<std::size_t>(level)].words().size();
  if (total >= kNoCell)
    throw Error("the DAG is too large: its nodes have more words than 32-bit pointers can address");
  const auto& leaves = nodes.back().words();
  const MemoryReservation copy(memory, (total + leaves.size()) * sizeof(std::uint32_t));
  dag.nodes.reserve(total);
  for (int level = 0; level < levels - 2; ++level) {
    const auto& words = nodes[static_cast<std::size_t>(level)].words();
    dag.level_begin[static_cast<std::size_t>(level)] = dag.nodes.size();
    const auto next = static_cast<std::uint32_t>(dag.nodes.size() + words.size());
    for (std::size_t i = 0; i < words.size();) {
      dag.nodes.push_back(words[i]);
      for (int left = popcount(words[i++]); left > 0; --left, ++i)
        dag.nodes.push_back(level == levels - 3 ? words[i] / 2 : next + words[i]);
    }
  }
  for (int level = levels - 2; level <= kMaxLevels; ++level)
    dag.level_begin[static_cast<std::size_t>(level)] = dag.nodes.size();
  dag.leaf_blocks.reserve(leaves.size() / 2);
  for (std::size_t i = 0; i < leaves.size(); i += 2)
    dag.leaf_blocks.push_back(leaves[i] | static_cast<std::uint64_t>(leaves[i + 1]) << 32);
  return dag;
}

}  // namespace voxdag::detail
