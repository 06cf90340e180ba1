#pragma once
/// Brings merged nodes into canonical order (stored/svdag/svdag.hpp), level by level from the root
/// down.
///
/// The nodes of a level are in the order in which the level above first refers to them. Each level
/// takes four steps. The owner of a run of ordered nodes sends their references, with their
/// positions, to the owners of the children. These find the first position of each child and send
/// the child to the owner of the run that the position is in, which sorts its run and answers with
/// the places of the nodes. At last the references are answered with these places.
///
/// Files, per level l and mailbox b, which owns run b:
///   merge/order-l-b   run b of the level: OrderedNode and the record of each node, until level
///                     l + 1 is done
///   merge/words-l-b   run b of the words of LongSvdagView::nodes, or of the leaf blocks
#include <cstdint>
#include <vector>

#include "voxdag/cluster/part_merge.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"

namespace voxdag {

/// The canonical DAG, whose words lie in files.
struct OrderedDag {
  SvdagCounts counts;
  std::vector<std::uint64_t> level_begin;  ///< levels - 1 values, as LEVL in docs/format.md.
  std::uint64_t leaf_blocks = 0;
  /// Whether the words need the layout of long_svdag.hpp: there are more than
  /// MergeJob::most_plain_words.
  bool has_long_pointers = false;
};

/// Returns the name of the file with a run of the words of a level.
std::string words_name(int level, std::uint32_t mailbox);

/// Orders the nodes. Goes on after the last level that is complete. Collective. Throws Error (also
/// if a level outgrows long pointers), OverMemory and Cancelled.
OrderedDag order_nodes(const MergeJob& job, const MergedNodes& merged);

}  // namespace voxdag
