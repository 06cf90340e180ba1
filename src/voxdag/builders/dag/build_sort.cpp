// The paper's own construction (SVDAG, Section 3): builds octrees of sub-volumes of at most 1024³,
// reduces each by sorting before it builds the next, joins them under a top tree, and reduces the
// whole once more.

#include <algorithm>
#include <functional>
#include <mutex>
#include <vector>

#include "voxdag/builders/dag/build_methods.hpp"
#include "voxdag/builders/dag/join_cells.hpp"
#include "voxdag/builders/dag/sort_tree.hpp"
#include "voxdag/builders/dag/stop_watch.hpp"
#include "voxdag/builders/dag/subvolume.hpp"
#include "voxdag/core/bits.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/core/parallel/per_thread.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/core/parallel/thread_count.hpp"
#include "voxdag/stored/svdag/canonical_order.hpp"

namespace voxdag {
namespace {

constexpr int kSubvolumeLevels = 10;

void require_32_bits(std::uint64_t nodes) {
  if (nodes * 9 >= kNoNode)
    throw Error(
        "the DAG is too large: one level of its sub-volumes has more nodes "
        "than 32-bit pointers can address");
}

/// Appends the nodes of `from` below those of `to`, level by level, from `level` down. Returns the
/// index of the root of `from`. Throws OverMemory before it changes anything.
std::uint32_t append(SortTree& to, const SortTree& from, std::size_t level, Work work) {
  const auto end_of = [&](std::size_t l) {
    const std::size_t end = l < to.levels.size() ? to.levels[l].size() : to.leaf_blocks.size();
    require_32_bits(end);
    return static_cast<std::uint32_t>(end);
  };
  const std::uint32_t root = end_of(level);
  for (std::size_t l = 0; l < from.levels.size(); ++l)
    to.levels[level + l].reserve(to.levels[level + l].size() + from.levels[l].size());
  to.leaf_blocks.reserve(to.leaf_blocks.size() + from.leaf_blocks.size());
  for (std::size_t l = 0; l < from.levels.size(); ++l) {
    const std::uint32_t below = end_of(level + l + 1);
    for (std::size_t i = 0; i < from.levels[l].size(); ++i) {
      work.poll_seldom(i);
      SortNode node = from.levels[l][i];
      for (std::uint32_t& pointer : node)
        if (pointer != kNoNode) pointer += below;
      to.levels[level + l].push_back(node);
    }
  }
  for (std::size_t i = 0; i < from.leaf_blocks.size(); ++i) {
    work.poll_seldom(i);
    to.leaf_blocks.push_back(from.leaf_blocks[i]);
  }
  return root;
}

/// Returns the bytes of the entries and indirections that the reduction of a tree needs at once.
std::uint64_t reduction_bytes(const SortTree& tree) {
  std::uint64_t bytes = tree.leaf_blocks.size() * 20;
  for (const auto& level : tree.levels) bytes = std::max<std::uint64_t>(bytes, level.size() * 40);
  return bytes;
}

/// The tree as the `source` of canonical_order(): ids become word offsets, from the leaf blocks up.
class WordSource {
 public:
  WordSource(SortTree& tree, Work work) : forwards_(work.memory) {
    for (std::size_t level = 0; level <= tree.levels.size(); ++level)
      words_.emplace_back(work.memory);
    forwards_.resize(tree.leaf_blocks.size());
    for (std::size_t i = 0; i < tree.leaf_blocks.size(); ++i) {
      work.poll_seldom(i);
      words_.back().push_back(static_cast<std::uint32_t>(tree.leaf_blocks[i]));
      words_.back().push_back(static_cast<std::uint32_t>(tree.leaf_blocks[i] >> 32));
    }
    PageVector<std::uint32_t> offsets(work.memory), next(work.memory);
    offsets.resize(tree.leaf_blocks.size());
    for (std::uint32_t i = 0; i < offsets.size(); ++i) offsets[i] = 2 * i;
    tree.leaf_blocks.release();
    for (std::size_t level = tree.levels.size(); level-- > 0;) {
      next.clear();
      for (std::size_t i = 0; i < tree.levels[level].size(); ++i) {
        work.poll_seldom(i);
        const SortNode& node = tree.levels[level][i];
        const std::size_t at = words_[level].size();
        next.push_back(static_cast<std::uint32_t>(at));
        words_[level].push_back(0);
        for (int child = 0; child < 8; ++child) {
          if (node[child] == kNoNode) continue;
          words_[level][at] |= 1u << child;
          words_[level].push_back(offsets[node[child]]);
        }
      }
      tree.levels[level].release();
      offsets.swap(next);
    }
    for (std::size_t level = 0; level + 1 < words_.size(); ++level)
      node_words_ += words_[level].size();
  }

  const std::uint32_t* words(int level, std::uint32_t id) const {
    return words_[level].data() + id;
  }
  std::uint64_t leaf_block(std::uint32_t id) const {
    return words_.back()[id] | static_cast<std::uint64_t>(words_.back()[id + 1]) << 32;
  }
  void prefetch(int, std::uint32_t) const {}
  void release(int level) { words_[level].release(); }
  std::uint64_t node_words() const { return node_words_; }
  std::uint64_t leaf_blocks() const { return forwards_.size(); }
  std::uint32_t& forward(int level, std::uint32_t id) {
    return level + 1 == static_cast<int>(words_.size()) ? forwards_[id / 2] : words_[level][id];
  }

 private:
  std::vector<PageVector<std::uint32_t>> words_;
  PageVector<std::uint32_t> forwards_;
  std::uint64_t node_words_ = 0;
};

/// Builds and reduces sub-volumes and appends them to one tree. Thread-safe.
class SortedSubvolumes {
 public:
  SortedSubvolumes(const BinnedMesh& binned, const BuildInput& input)
      : tree(std::max(0, input.grid.levels - 2), input.work.memory),
        roots(binned.bins.cells.size(), kNoNode),
        bytes(binned.bins.cells.size()),
        binned_(binned),
        input_(input) {}

  /// Throws OverMemory before it appends anything.
  void add(std::size_t i, SortTimes& times) {
    const SubvolumeBins& bins = binned_.bins;
    const int levels = input_.grid.levels, log2_size = levels - bins.level;
    const Vec3i cell = morton_decode(bins.cells[i]);
    SubvolumeContext<TreeSink> context(
        binned_.mesh, levels, TreeSink(levels, bins.level, *input_.work.memory), input_.work);
    const NodeId root = build_subvolume(
        context,
        {{cell.x << log2_size, cell.y << log2_size, cell.z << log2_size}, log2_size, bins.list(i)});
    // In the largest grids, bins can list triangles that miss the cell.
    if (root == kNoNode) return;
    SortTree reduced = std::move(context.sink.tree);
    bytes[i] = static_cast<double>(reduced.bytes() + reduction_bytes(reduced));
    const bool one_at_a_time = input_.method == BuildMethod::kPaper;
    reduce_by_sorting(reduced, false, one_at_a_time, times, input_.work);
    StopWatch watch;
    const std::lock_guard guard(mutex_);
    roots[i] = append(tree, reduced, bins.level, input_.work);
    // With several threads, much of this time is spent in waiting for each other.
    if (one_at_a_time) times.reduce += watch.lap();
  }

  SortTree tree;
  std::vector<NodeId> roots;  ///< Root of each sub-volume, as an index into its level.
  std::vector<double> bytes;  ///< Most bytes that each sub-volume took.

 private:
  std::mutex mutex_;
  const BinnedMesh& binned_;
  const BuildInput& input_;
};

/// Adds all sub-volumes, on all threads at the same time. Returns their seconds, summed over the
/// threads.
SortTimes add_in_parallel(SortedSubvolumes& subvolumes, const BuildInput& input) {
  const std::size_t count = subvolumes.roots.size(), threads = thread_count(count);
  PerThread<SortTimes> times;
  // Sub-volumes that did not fit into memory together are built again, one at a time.
  std::vector<std::size_t> postponed;
  std::mutex postponed_mutex;
  polled_for(count, 1, input.work, "voxelize", [&](std::size_t i) {
    try {
      subvolumes.add(i, times.local());
    } catch (const OverMemory&) {
      if (threads == 1) throw;
      const std::lock_guard guard(postponed_mutex);
      postponed.push_back(i);
    }
  });
  for (const std::size_t i : postponed) subvolumes.add(i, times.local());
  SortTimes sum;
  for (const SortTimes& t : times) {
    sum.reduce += t.reduce;
    sum.sort += t.sort;
  }
  return sum;
}

/// Adds one sub-volume after the other. Returns their wall-clock seconds.
SortTimes add_in_order(SortedSubvolumes& subvolumes, const BuildInput& input) {
  SortTimes times;
  const std::size_t count = subvolumes.roots.size();
  for (std::size_t i = 0; i < count; ++i) {
    input.work.poll();
    subvolumes.add(i, times);
    input.work.report("voxelize", static_cast<double>(i + 1) / static_cast<double>(count));
  }
  return times;
}

}  // namespace

int sort_bin_level(int levels) { return std::max(0, levels - kSubvolumeLevels); }

SortTree voxelize_by_sorting(const BuildInput& input, BuildReport& report, StageBytes& bytes) {
  StopWatch watch;
  const BinnedMesh binned = bin_mesh(input);
  const SubvolumeBins& bins = binned.bins;
  report.quantize_seconds = watch.lap();
  report.subvolumes = bins.cells.size();
  const bool one_at_a_time = input.method == BuildMethod::kPaper;
  const std::size_t threads = one_at_a_time ? 1 : thread_count(bins.cells.size());
  bytes.prepare = binned.prepare_bytes;
  bytes.voxelize_fixed = static_cast<double>(input.work.memory->used()) +
                         static_cast<double>(threads) * list_scratch_bytes(bins);

  SortedSubvolumes subvolumes(binned, input);
  const SortTimes times =
      one_at_a_time ? add_in_order(subvolumes, input) : add_in_parallel(subvolumes, input);
  report.reduce_seconds += times.reduce;
  report.sort_seconds += times.sort;

  SortTree& tree = subvolumes.tree;
  std::vector<double>& largest = subvolumes.bytes;
  std::sort(largest.begin(), largest.end(), std::greater<>());
  bytes.voxelize = static_cast<double>(tree.bytes());
  for (std::size_t i = 0; i < threads && i < largest.size(); ++i) bytes.voxelize += largest[i];
  bytes.merge = static_cast<double>(tree.bytes() + reduction_bytes(tree));
  join_cells(bins.level, {bins.cells.begin(), bins.cells.end()}, std::move(subvolumes.roots),
             [&](int level, const std::uint32_t* words, int) {
               SortNode node;
               node.fill(kNoNode);
               for (std::uint32_t left = words[0]; left != 0; left &= left - 1)
                 node[std::countr_zero(left)] = *++words;
               tree.levels[level].push_back(node);
               return static_cast<NodeId>(tree.levels[level].size() - 1);
             });
  report.voxelize_seconds = watch.lap();
  return std::move(tree);
}

Svdag merge_and_number(SortTree tree, const BuildInput& input, BuildReport& report) {
  Svdag dag;
  dag.levels = input.grid.levels;
  if (tree.leaf_blocks.empty()) return dag;
  StopWatch watch;
  SortTimes times;
  reduce_by_sorting(tree, true, true, times, input.work);
  report.reduce_seconds += times.reduce;
  report.sort_seconds += times.sort;
  report.merge_seconds = watch.lap();
  WordSource source(tree, input.work);
  dag = canonical_order(source, dag.levels, 0, input.work);
  report.canonical_seconds = watch.lap();
  return dag;
}

}  // namespace voxdag
