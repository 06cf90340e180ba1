#include "voxdag/algebra/coarsen.hpp"

#include <cassert>

#include "voxdag/algebra/source_dag.hpp"

namespace voxdag {
namespace {

/// A key is a node. Cells of the coarser grid's level L-2 become leaf blocks.
class CoarsenRule {
 public:
  static constexpr std::size_t kWords = 1;
  using Key = std::array<std::uint32_t, kWords>;

  CoarsenRule(const SvdagView& dag, int levels) : source_(dag), levels_(levels) {}

  Key root() const { return {source_.root()}; }
  void children(int level, const Key& key, Key (&keys)[8]) const {
    for (int i = 0; i < 8; ++i) keys[i] = {source_.child(level, key[0], i)};
  }
  std::uint64_t block(const Key& key) const {
    if (levels_ == source_.view().levels) return source_.block(key[0]);
    std::uint64_t block = 0;
    for (int i = 0; i < 8; ++i) {
      const std::uint32_t child = source_.child(levels_ - 2, key[0], i);
      if (child != kNoCell) block |= static_cast<std::uint64_t>(mask_of(child)) << (8 * i);
    }
    return block;
  }

 private:
  /// Returns the child mask of a node of level levels_ - 1.
  std::uint32_t mask_of(std::uint32_t node) const {
    const SvdagView& dag = source_.view();
    return levels_ - 1 == dag.levels - 2 ? leaf_block_child_mask(dag.leaf_blocks[node])
                                         : child_mask(dag.nodes + node);
  }

  SourceDag source_;
  int levels_;
};

}  // namespace

Svdag coarsen(const SvdagView& dag, int levels, MemoryBudget* memory, Progress* progress) {
  assert(levels >= kMinLevels && levels <= dag.levels);
  return rewrite(CoarsenRule(dag, levels), levels, memory, progress);
}

}  // namespace voxdag
