#include "voxdag/cpu/packets/bounded_dag.hpp"

#include <algorithm>
#include <vector>

#include "voxdag/core/page_vector.hpp"
#include "voxdag/core/parallel/parallel_for.hpp"

namespace voxdag {
namespace {

/// Returns the first words of some nodes in [begin, end), about kRun words apart.
std::vector<std::uint64_t> runs_of(const SvdagView& dag, std::uint64_t begin, std::uint64_t end) {
  constexpr std::uint64_t kRun = 1 << 14;
  std::vector<std::uint64_t> runs{begin};
  for (std::uint64_t at = begin; at < end;
       at += 1 + static_cast<std::uint64_t>(popcount8(child_mask(dag.nodes + at))))
    if (at - runs.back() >= kRun) runs.push_back(at);
  runs.push_back(end);
  return runs;
}

/// Prefetches the node of a pointer a few words ahead. If that word is a mask, the prefetch is
/// harmless.
void prefetch(const SvdagView& dag, int level, std::uint64_t at, const std::uint32_t* words) {
  constexpr std::uint64_t kAhead = 64;
  if (at + kAhead + 8 >= dag.level_begin[level + 1]) return;
  for (std::uint64_t i = 0; i < 8; ++i) {
    const std::uint64_t child = dag.nodes[at + kAhead + i];
    if (level == dag.levels - 3)
      __builtin_prefetch(dag.leaf_blocks + child);
    else
      __builtin_prefetch(words + 2 * child + 1);
  }
}

/// Makes the node at word `at` of the DAG; its children must be made already. Returns its number of
/// words in the DAG.
std::uint64_t make_node(const SvdagView& dag, int level, std::uint64_t at, std::uint32_t* words) {
  const std::uint32_t mask = child_mask(dag.nodes + at);
  write_bounded_node(mask, words + 2 * at, [&](std::uint32_t i, std::uint32_t) {
    const std::uint32_t child = dag.nodes[at + 1 + i];
    return BoundedChild{child, level == dag.levels - 3
                                   ? box_of(dag.leaf_blocks[child])
                                   : bounded_node_box(words + 2 * std::uint64_t{child})};
  });
  return 1 + static_cast<std::uint64_t>(popcount8(mask));
}

}  // namespace

BoundedDag::BoundedDag(const SvdagNodes& nodes)
    : nodes_(nodes), words_(make_large_array<std::uint32_t>(word_count())) {
  const SvdagView& dag = nodes_.view();
  std::fill_n(words_.get() + 2 * dag.node_words(), 7, 0);
  for (int level = dag.levels - 3; level >= 0; --level) {
    const std::vector<std::uint64_t> runs =
        runs_of(dag, dag.level_begin[level], dag.level_begin[level + 1]);
    parallel_for(runs.size() - 1, [&](std::size_t run) {
      for (std::uint64_t at = runs[run]; at < runs[run + 1];) {
        prefetch(dag, level, at, words_.get());
        at += make_node(dag, level, at, words_.get());
      }
    });
  }
}

}  // namespace voxdag
