#include "lab/compact/ssvdag.hpp"

#include "lab/compact/reference_order.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag::lab {
namespace {

constexpr std::uint64_t kShortPlaces = 1 << 13, kPlaces = 1 << 30;

}  // namespace

SizeInParts ssvdag_size(const MergedDag& dag) {
  if (dag.leaf_blocks.empty()) return {};
  std::uint64_t short_words = 0, long_words = 0;
  const std::uint64_t tag_words =
      place_levels(dag.nodes, dag.leaf_blocks.size(),
                   [&](std::size_t, const std::vector<std::uint64_t>& places) {
                     return [&](const MergedChild& child) -> std::uint64_t {
                       if (places[child.node] >= kPlaces)
                         throw Error("a level is too large for an SSVDAG");
                       const bool is_short = places[child.node] < kShortPlaces;
                       const std::uint64_t words = is_short ? 1 : 2;
                       (is_short ? short_words : long_words) += words;
                       return words;
                     };
                   });
  return {{{"tags", 2 * tag_words},
           {"16-bit pointers", 2 * short_words},
           {"32-bit pointers", 2 * long_words},
           {"leaves", 8 * dag.leaf_blocks.size()},
           {"starts of levels", 4 * dag.nodes.size()}}};
}

SizeInParts ssvdag_size(const SvdagView& dag, const Progress& progress) {
  if (dag.is_empty()) return {};
  return ssvdag_size(merge_nodes(list_nodes(dag), MergeRule::kPublishedMirrors, progress));
}

}  // namespace voxdag::lab
