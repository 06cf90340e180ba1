#pragma once
/// Which nodes of a DAG are full: all voxels in them are set.
#include <vector>

#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

class FullNodes {
 public:
  /// Takes memory for one bit per word of the DAG.
  explicit FullNodes(const SvdagView& dag);

  /// Returns whether the node of `level` (0 to L-2) that a pointer names is full. The root of a DAG
  /// that is not empty has pointer 0.
  bool is_full(int level, std::uint32_t pointer) const {
    if (level == dag_.levels - 2) return dag_.leaf_blocks[pointer] == ~std::uint64_t{0};
    return full_[pointer];
  }

 private:
  SvdagView dag_;
  std::vector<bool> full_;  ///< By the first word of the node.
};

/// Calls fn(at) for the nodes of a level above the leaf blocks; `at` is the place of their mask.
template <class Fn>
void for_each_node(const SvdagView& dag, int level, const Fn& fn) {
  for (std::uint64_t at = dag.level_begin[level]; at < dag.level_begin[level + 1];
       at += 1 + static_cast<std::uint64_t>(popcount8(child_mask(dag.nodes + at))))
    fn(at);
}

}  // namespace voxdag
