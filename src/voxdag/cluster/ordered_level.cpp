#include "voxdag/cluster/ordered_level.hpp"

#include <algorithm>
#include <bit>
#include <mutex>

namespace voxdag {
namespace {

/// Returns the index of a mailbox among those of its rank.
std::size_t own_index(const MergeJob& job, std::uint32_t box) {
  return box / static_cast<std::uint32_t>(job.ranks.count());
}
/// Returns the most mailboxes that a rank has.
std::size_t most_own(const MergeJob& job) {
  const auto ranks = static_cast<std::size_t>(job.ranks.count());
  return (job.mailboxes + ranks - 1) / ranks;
}

/// Returns the values of all mailboxes, `each` of them per mailbox; `mine` has those of this
/// rank, most_own() times `each`. Collective.
std::vector<std::uint64_t> gather(const MergeJob& job, const std::vector<std::uint64_t>& mine,
                                  std::size_t each) {
  const auto ranks = static_cast<std::size_t>(job.ranks.count());
  const std::vector<std::uint64_t> gathered = job.ranks.all_gather(mine);
  std::vector<std::uint64_t> all(job.mailboxes * each);
  for (std::size_t box = 0; box < job.mailboxes; ++box)
    std::copy_n(&gathered[box % ranks * mine.size() + box / ranks * each], each, &all[box * each]);
  return all;
}

}  // namespace

std::string order_name(int level, std::uint32_t box) {
  return mailbox_name("merge/order-" + std::to_string(level), box);
}

LevelRuns runs_of(const MergeJob& job, int level) {
  const bool is_leaf = level == job.levels - 2;
  // Per mailbox: nodes, references, copies.
  std::vector<std::uint64_t> mine(3 * most_own(job));
  for_each_own(job.ranks, job.mailboxes, job.work, [&](std::uint32_t box) {
    const WorkFile file = job.folder.open_written(order_name(level, box), job.work);
    std::uint64_t nodes = 0, references = 0, copies = 0;
    for_each_node(file, is_leaf, job.work, [&](const OrderedNode& node, const std::byte* record) {
      ++nodes;
      copies += node.copies;
      references += static_cast<std::uint64_t>(record_ids(record, is_leaf));
    });
    const std::uint64_t values[] = {nodes, references, copies};
    std::copy_n(values, 3, &mine[3 * own_index(job, box)]);
  });
  const std::vector<std::uint64_t> all = gather(job, mine, 3);
  LevelRuns runs;
  std::uint64_t reference = 0, place = 0;
  for (std::uint32_t box = 0; box < job.mailboxes; ++box) {
    const std::uint64_t *of_box = &all[3 * box], nodes = of_box[0];
    runs.first_reference.push_back(reference);
    runs.first_place.push_back(place);
    reference += of_box[1];
    place += is_leaf ? nodes : nodes + of_box[1];
    runs.nodes += nodes;
    runs.copies += of_box[2];
  }
  runs.first_reference.push_back(reference);
  runs.first_place.push_back(place);
  return runs;
}

void count_leaves(const MergeJob& job, SvdagCounts& counts) {
  // Copies of octants, voxels, and a bit for each octant that occurs.
  std::vector<std::uint64_t> mine(2 + 4);
  std::mutex mutex;
  for_each_own(job.ranks, job.mailboxes, job.work, [&](std::uint32_t box) {
    std::uint64_t sums[2] = {}, bits[4] = {};
    const WorkFile file = job.folder.open_written(order_name(job.levels - 2, box), job.work);
    for_each_node(file, true, job.work, [&](const OrderedNode& node, const std::byte* record) {
      std::uint64_t block;
      std::memcpy(&block, record, sizeof block);
      sums[0] +=
          node.copies * static_cast<std::uint64_t>(std::popcount(leaf_block_child_mask(block)));
      sums[1] += node.copies * static_cast<std::uint64_t>(std::popcount(block));
      for (; block != 0; block >>= 8) bits[(block & 0xFF) / 64] |= 1ull << (block & 63);
    });
    const std::lock_guard guard(mutex);
    for (int i = 0; i < 2; ++i) mine[i] += sums[i];
    for (int i = 0; i < 4; ++i) mine[2 + i] |= bits[i];
  });
  const std::vector<std::uint64_t> all = job.ranks.all_gather(mine);
  std::uint64_t octants = 0;
  std::uint64_t seen[4] = {};
  for (std::size_t i = 0; i < all.size(); i += mine.size()) {
    octants += all[i];
    counts.voxels += all[i + 1];
    for (std::size_t w = 0; w < 4; ++w) seen[w] |= all[i + 2 + w];
  }
  seen[0] &= ~1ull;  // the empty octant
  counts.svo_nodes_per_level.push_back(octants);
  std::uint64_t different = 0;
  for (const std::uint64_t bits : seen)
    different += static_cast<std::uint64_t>(std::popcount(bits));
  counts.dag_nodes_per_level.push_back(different);
}

}  // namespace voxdag
