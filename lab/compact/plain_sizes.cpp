#include "lab/compact/plain_sizes.hpp"

#include "voxdag/stored/svdag/svdag_counts.hpp"

namespace voxdag::lab {

SizeInParts svo_size(const SvdagView& dag) {
  return {{{"child masks", count_svdag(dag).svo_nodes()}}};
}

SizeInParts svdag_size(const SvdagView& dag) {
  std::uint64_t masks = 0;
  for (std::uint64_t at = 0; at < dag.node_words(); at += 1 + popcount8(child_mask(dag.nodes + at)))
    ++masks;
  return {{{"child masks", 4 * masks},
           {"pointers", 4 * (dag.node_words() - masks)},
           {"leaf blocks", 8 * dag.leaf_block_count}}};
}

}  // namespace voxdag::lab
