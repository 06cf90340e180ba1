#include "voxdag/algebra/attributes/equal_nodes.hpp"

namespace voxdag {

NodeClasses EqualNodes::add(const SvdagView& dag, int finest) {
  while (nodes_.size() < static_cast<std::size_t>(dag.levels - 1)) nodes_.emplace_back(memory_);
  NodeClasses classes(memory_);
  classes.words_.resize(dag.node_words());
  classes.blocks_.resize(dag.leaf_block_count);
  // Cells of the finest level are equal, whatever is below them, and stay of class 0.
  for (std::uint64_t i = 0; i < dag.leaf_block_count && finest > dag.levels - 2; ++i) {
    const std::uint64_t block =
        finest == dag.levels ? dag.leaf_blocks[i] : leaf_block_child_mask(dag.leaf_blocks[i]);
    const std::uint32_t words[] = {static_cast<std::uint32_t>(block),
                                   static_cast<std::uint32_t>(block >> 32)};
    classes.blocks_[i] = nodes_[0].add(words, 2);
  }
  for (int level = dag.levels - 3; level >= 0; --level) {
    if (level >= finest) continue;
    UniqueNodes& nodes = nodes_[static_cast<std::size_t>(dag.levels - 2 - level)];
    for (std::uint64_t at = dag.level_begin[level]; at < dag.level_begin[level + 1];) {
      std::array<std::uint32_t, 9> words{child_mask(dag.nodes + at)};
      const auto size = 1 + static_cast<std::size_t>(popcount(words[0]));
      for (std::size_t i = 1; i < size; ++i) {
        const std::uint32_t child = dag.nodes[at + i];
        words[i] = level == dag.levels - 3 ? classes.blocks_[child] : classes.words_[child];
      }
      classes.words_[at] = nodes.add(words.data(), size);
      at += size;
    }
  }
  return classes;
}

}  // namespace voxdag
