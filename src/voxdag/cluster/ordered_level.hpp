#pragma once
/// The ordered nodes of a level: the files merge/order-L-B of numbering.
///
///   for each node: u64 copies, record (node_record.hpp)
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "voxdag/cluster/mailboxes.hpp"
#include "voxdag/cluster/node_record.hpp"
#include "voxdag/cluster/part_merge.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"

namespace voxdag {

/// The head of an ordered node.
struct OrderedNode {
  std::uint64_t copies;  ///< Number of nodes of the octree that this node stands for.
};

/// The sizes of a level and of its runs. The last entry of each array is the size of the level.
struct LevelRuns {
  std::vector<std::uint64_t> first_reference;  ///< Per run: the first of its references.
  std::vector<std::uint64_t> first_place;      ///< Per run: its first word, or first leaf block.
  std::uint64_t nodes = 0, copies = 0;
};

/// Returns the name of the file with run `box` of a level.
std::string order_name(int level, std::uint32_t box);

/// Reads the sizes of a level from the files of its runs. Collective. Throws Error and Cancelled.
LevelRuns runs_of(const MergeJob& job, int level);

/// Adds the octants below the leaf blocks, and the voxels, to the counts. Collective. Throws Error
/// and Cancelled.
void count_leaves(const MergeJob& job, SvdagCounts& counts);

/// Reads a value and moves `at` behind it.
template <class T>
T take_value(const std::byte*& at) {
  T value;
  std::memcpy(&value, at, sizeof value);
  at += sizeof value;
  return value;
}

/// Calls body(OrderedNode, record) for the nodes of a run, and drops pages that it has read.
/// Throws Cancelled.
template <class Body>
void for_each_node(const WorkFile& file, bool is_leaf, Work work, const Body& body) {
  constexpr std::uint64_t kRelease = std::uint64_t{1} << 20;
  const std::byte* at = file.bytes().data();
  const std::byte* const end = at + file.bytes().size();
  for (std::uint64_t count = 1; at != end; ++count) {
    work.poll_seldom(count);
    if (count % kRelease == 0) file.release(static_cast<std::size_t>(at - file.bytes().data()));
    const auto node = take_value<OrderedNode>(at);
    body(node, at);
    at += record_bytes(at, is_leaf);
  }
}

}  // namespace voxdag
