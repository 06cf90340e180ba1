// The paper's own construction (SVDAG, Section 3): octrees of sub-volumes of at most 1024³, each
// reduced by sorting before the next is made, joined under a top tree and reduced once more.
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <vector>

#include "voxdag/core/bits.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/dag/build_methods.hpp"
#include "voxdag/dag/canonical_order.hpp"
#include "voxdag/dag/sort_reduce.hpp"
#include "voxdag/dag/subvolume.hpp"
#include "voxdag/dag/subvolume_bins.hpp"
#include "voxdag/parallel/parallel_for.hpp"

namespace voxdag {
namespace {

constexpr int kSubvolumeLevels = 10;

/// The explicit octree of one sub-volume; its sink is emptied.
SortTree take_tree(TreeSink& sink, int root_level) {
  SortTree tree;
  for (std::size_t level = root_level; level < sink.nodes.size(); ++level)
    tree.levels.push_back(std::move(sink.nodes[level]));
  tree.leaf_blocks = std::move(sink.leaf_blocks);
  for (auto& level : sink.nodes) level.clear();
  sink.leaf_blocks.clear();
  return tree;
}

/// Appends the nodes of `from` below those of `to`, level by level, from `level` down.
void append(SortTree& to, const SortTree& from, std::size_t level) {
  const auto shifted = [](SortNode node, std::size_t by) {
    for (std::uint32_t& pointer : node)
      if (pointer != kNoNode) pointer += static_cast<std::uint32_t>(by);
    return node;
  };
  for (std::size_t l = 0; l < from.levels.size(); ++l) {
    const std::size_t below =
        level + l + 1 < to.levels.size() ? to.levels[level + l + 1].size() : to.leaf_blocks.size();
    for (const SortNode& node : from.levels[l])
      to.levels[level + l].push_back(shifted(node, below));
  }
  to.leaf_blocks.insert(to.leaf_blocks.end(), from.leaf_blocks.begin(), from.leaf_blocks.end());
}

/// Adds the nodes above `level`, whose nodes are those of the cells (Morton codes, ascending).
void add_top(SortTree& tree, int level, std::vector<std::uint32_t> cells) {
  for (; level > 0; --level) {
    std::vector<SortNode>& parents = tree.levels[level - 1];
    std::size_t kept = 0;
    for (std::uint32_t i = 0; i < cells.size();) {
      const std::uint32_t parent = cells[i] >> 3;
      SortNode node;
      node.fill(kNoNode);
      for (; i < cells.size() && cells[i] >> 3 == parent; ++i) node[cells[i] & 7] = i;
      parents.push_back(node);
      cells[kept++] = parent;
    }
    cells.resize(kept);
  }
}

/// canonical_order's view: ids become word offsets, from the leaf blocks up.
class WordSource {
 public:
  explicit WordSource(SortTree& tree) : words_(tree.levels.size() + 1) {
    forwards_.resize(tree.leaf_blocks.size());
    for (std::uint64_t block : tree.leaf_blocks) {
      words_.back().push_back(static_cast<std::uint32_t>(block));
      words_.back().push_back(static_cast<std::uint32_t>(block >> 32));
    }
    std::vector<std::uint32_t> offsets(tree.leaf_blocks.size()), next;
    for (std::uint32_t i = 0; i < offsets.size(); ++i) offsets[i] = 2 * i;
    for (std::size_t level = tree.levels.size(); level-- > 0;) {
      next.clear();
      for (const SortNode& node : tree.levels[level]) {
        next.push_back(static_cast<std::uint32_t>(words_[level].size()));
        words_[level].push_back(0);
        for (int child = 0; child < 8; ++child) {
          if (node[child] == kNoNode) continue;
          words_[level][next.back()] |= 1u << child;
          words_[level].push_back(offsets[node[child]]);
        }
      }
      std::vector<SortNode>().swap(tree.levels[level]);
      offsets.swap(next);
    }
    node_words_ = 0;
    for (std::size_t level = 0; level + 1 < words_.size(); ++level)
      node_words_ += words_[level].size();
  }

  std::uint32_t* words(int level, std::uint32_t id) { return words_[level].data() + id; }
  void prefetch(int, std::uint32_t) const {}
  void release(int level) { std::vector<std::uint32_t>().swap(words_[level]); }
  std::uint64_t node_words() const { return node_words_; }
  std::uint64_t leaf_blocks() const { return forwards_.size(); }
  std::uint32_t& forward(std::uint32_t leaf) { return forwards_[leaf / 2]; }

 private:
  std::vector<std::vector<std::uint32_t>> words_;
  std::vector<std::uint32_t> forwards_;
  std::uint64_t node_words_;
};

void require_32_bits(const SortTree& tree) {
  std::uint64_t most = tree.leaf_blocks.size() * 2;
  for (const auto& level : tree.levels) most = std::max<std::uint64_t>(most, level.size() * 9);
  if (most >= kNoNode)
    throw Error("the DAG is too large: one level of its sub-volumes outgrew 32-bit pointers");
}

}  // namespace

BuildResult build_by_sorting(const QuantizedMesh& mesh, int levels, MemoryBudget& budget,
                             Progress* progress) {
  BuildResult result;
  StopWatch watch;
  const int root_level = std::max(0, levels - kSubvolumeLevels);
  const SubvolumeBins bins = bin_triangles(mesh, levels, root_level, budget, progress);
  result.report.quantize_seconds = watch.lap();
  result.report.subvolumes = bins.cells.size();

  using Context = SubvolumeContext<TreeSink>;
  tbb::enumerable_thread_specific<Context> contexts(
      [&] { return Context(mesh, levels, TreeSink(levels)); });
  tbb::enumerable_thread_specific<SortTimes> times;
  std::vector<SortTree> trees(bins.cells.size());
  std::atomic<std::uint64_t> done{0};
  const int log2_size = levels - root_level;
  parallel_for(bins.cells.size(), [&](std::size_t i) {
    if (progress != nullptr && progress->cancelled()) return;
    if (budget.exceeded()) return;
    const Vec3i cell = morton_decode(bins.cells[i]);
    Context& context = contexts.local();
    build_subvolume(
        context,
        {{cell.x << log2_size, cell.y << log2_size, cell.z << log2_size}, log2_size, bins.list(i)});
    trees[i] = take_tree(context.sink, root_level);
    const std::uint64_t unreduced = trees[i].bytes();
    budget.add(2 * unreduced);  // the octree, and the larger of its sort's tables
    reduce_by_sorting(trees[i], false, false, times.local());
    budget.add(trees[i].bytes());
    budget.remove(2 * unreduced);
    const std::uint64_t finished = done.fetch_add(1, std::memory_order_relaxed) + 1;
    if (progress != nullptr)
      progress->report("voxelize",
                       static_cast<double>(finished) / static_cast<double>(trees.size()));
  });
  if (progress != nullptr) progress->throw_if_cancelled();
  if (budget.exceeded())
    throw_over_memory(budget, static_cast<double>(done.load()) /
                                  static_cast<double>(std::max<std::size_t>(1, trees.size())));
  SortTimes all_times;
  for (const SortTimes& t : times) {
    all_times.reduce += t.reduce;
    all_times.sort += t.sort;
  }
  const double subvolume_seconds = watch.lap();

  // A sub-volume that only the conservative test of the largest cells kept has no root.
  SortTree whole;
  whole.levels.resize(std::max(0, levels - 2));
  std::vector<std::uint32_t> cells;
  for (std::size_t i = 0; i < trees.size(); ++i) {
    if (trees[i].leaf_blocks.empty()) continue;
    append(whole, trees[i], root_level);
    budget.add(trees[i].bytes());
    trees[i] = SortTree();
    cells.push_back(bins.cells[i]);
  }
  require_32_bits(whole);
  if (budget.exceeded()) throw_over_memory(budget, 1);
  add_top(whole, root_level, cells);
  reduce_by_sorting(whole, true, true, all_times);
  if (progress != nullptr) progress->throw_if_cancelled();
  result.report.voxelize_seconds = subvolume_seconds;
  result.report.reduce_seconds = all_times.reduce;
  result.report.sort_seconds = all_times.sort;
  result.report.merge_seconds = watch.lap();

  result.dag.levels = levels;
  if (!whole.leaf_blocks.empty()) {
    budget.add(whole.bytes());
    if (budget.exceeded()) throw_over_memory(budget, 1);
    WordSource source(whole);
    result.dag = canonical_order(source, levels, 0);
  }
  result.report.canonical_seconds = watch.lap();
  result.report.peak_bytes = budget.peak();
  return result;
}

}  // namespace voxdag
