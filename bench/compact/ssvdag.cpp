#include "bench/compact/ssvdag.hpp"

#include "bench/compact/reference_order.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

constexpr std::uint64_t kShortPlaces = 1 << 13, kPlaces = 1 << 30;

}  // namespace

SizeInParts ssvdag_size(const MergedDag& dag) {
  if (dag.leaf_blocks.empty()) return {};
  std::uint64_t tag_words = 0, short_words = 0, long_words = 0;
  // The places of the nodes of the level below.
  std::vector<std::uint64_t> places(dag.leaf_blocks.size());
  const std::size_t inner_levels = dag.nodes.size();
  if (inner_levels > 0) {
    std::uint64_t place = 0;
    for (const std::uint32_t leaf : reference_order(dag.nodes[inner_levels - 1], places.size()))
      places[leaf] = place++;
  }
  for (std::size_t level = inner_levels; level-- > 0;) {
    const std::vector<MergedNode>& nodes = dag.nodes[level];
    const std::vector<std::uint32_t> order =
        level == 0 ? std::vector<std::uint32_t>{0}
                   : reference_order(dag.nodes[level - 1], nodes.size());
    std::vector<std::uint64_t> here(nodes.size());
    std::uint64_t words = 0;
    for (const std::uint32_t i : order) {
      here[i] = words++;
      ++tag_words;
      for (const MergedChild& child : nodes[i]) {
        if (child.node == kNoNode) continue;
        const bool is_short = places[child.node] < kShortPlaces;
        if (places[child.node] >= kPlaces) throw Error("a level is too large for an SSVDAG");
        words += is_short ? 1 : 2;
        (is_short ? short_words : long_words) += is_short ? 1 : 2;
      }
    }
    places = std::move(here);
  }
  return {{{"tags", 2 * tag_words},
           {"16-bit pointers", 2 * short_words},
           {"32-bit pointers", 2 * long_words},
           {"leaves", 8 * dag.leaf_blocks.size()},
           {"starts of levels", 4 * inner_levels}}};
}

SizeInParts ssvdag_size(const SvdagView& dag, const Progress& progress) {
  if (dag.is_empty()) return {};
  return ssvdag_size(merge_nodes(list_nodes(dag), MergeRule::kPublishedMirrors, progress));
}

}  // namespace voxdag
