#pragma once
/// Merges the DAGs of all parts, level by level from the leaf blocks up.
///
/// Each level takes three steps. The owner of a part sends each node of the level to the mailbox
/// that its hash decides, with the ids of its children. The owner of the mailbox gives equal nodes
/// one id, stores the different ones, and answers with the ids. The owner of the part collects them
/// for the level above.
///
/// Files, per level l and mailbox b:
///   merge/nodes-l-b   the records of the different nodes, in the order of their numbers
///   merge/ids-l-b     u64 ids of the nodes of the parts of mailbox b; until level l - 1 is done
#include <cstdint>
#include <string>
#include <vector>

#include "voxdag/cluster/part_file.hpp"
#include "voxdag/cluster/ranks.hpp"
#include "voxdag/cluster/work_folder.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/long_svdag.hpp"

namespace voxdag {

/// The inputs and the limits of a merge.
struct MergeJob {
  Ranks& ranks;
  const WorkFolder& folder;
  int levels;  ///< The grid has 2^levels voxels a side.
  PartFiles& parts;
  std::uint32_t mailboxes;  ///< Number of owners of nodes.
  Work work;                ///< Has a budget.
  /// The plain layout of nodes holds so many words; more need long pointers.
  std::uint64_t most_plain_words = kMaxPlainWords;
};

/// The nodes of merged levels. Ids are those of node_record.hpp.
struct MergedNodes {
  std::uint64_t root = 0;
  bool is_empty = true;
};

/// Returns the name of the file with the nodes of a level that a mailbox owns.
std::string merged_name(int level, std::uint32_t mailbox);

/// Returns mailboxes_of() for the level of the parts that needs the most memory. Collective.
std::uint32_t mailboxes_for(Ranks& ranks, PartFiles& parts, const MemoryBudget& budget);

/// Merges the parts. Goes on after the last level that is complete. Collective. Throws Error,
/// OverMemory and Cancelled.
MergedNodes merge_parts(const MergeJob& job);

}  // namespace voxdag
