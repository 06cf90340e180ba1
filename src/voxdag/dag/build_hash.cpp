// Depth-first, hash-consed construction: design, "From mesh to minimal DAG".
//
// The sub-volumes are built in parallel into tables that all threads share, so that there is
// nothing to merge; the few nodes above them follow serially.
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <memory>
#include <vector>

#include "voxdag/core/morton.hpp"
#include "voxdag/dag/build_methods.hpp"
#include "voxdag/dag/canonical_order.hpp"
#include "voxdag/dag/subvolume.hpp"
#include "voxdag/dag/subvolume_bins.hpp"
#include "voxdag/parallel/parallel_for.hpp"

namespace voxdag {
namespace {

constexpr int kLog2MemoSets = 16;  // 8 MiB for each thread

using Stores = std::vector<std::unique_ptr<NodeStore>>;

/// Sub-volumes small enough to share out well, large enough to seldom cut a triangle.
int subvolume_level(int levels, std::size_t triangles) {
  int level = std::clamp(levels - 5, 0, 6);
  // About 1024 triangles for each of the ~4^level cells of a surface.
  while (level < levels - 2 && level < 10 && (triangles >> (2 * level)) > 1024) ++level;
  // The recursion goes two levels at a time.
  if ((levels - level) % 2 != 0) level += level > 0 ? -1 : 1;
  return level;
}

/// canonical_order's view of the stores.
struct StoreSource {
  Stores& stores;
  std::vector<std::uint32_t> forwards;  // by half the leaf's id: all of them are even

  explicit StoreSource(Stores& all) : stores(all), forwards(stores.back()->end_id() / 2) {}
  std::uint32_t* words(int level, NodeId id) { return stores[level]->words(id); }
  void prefetch(int level, NodeId id) const {
    stores[level]->prefetch_words(id);
    if (level + 1 == static_cast<int>(stores.size()) && id / 2 < forwards.size())
      __builtin_prefetch(&forwards[id / 2], 1);
  }
  void release(int level) { stores[level]->release(); }
  std::uint64_t node_words() const {
    std::uint64_t words = 0;
    for (std::size_t i = 0; i + 1 < stores.size(); ++i) words += stores[i]->word_count();
    return words;
  }
  std::uint64_t leaf_blocks() const { return stores.back()->node_count(); }
  std::uint32_t& forward(NodeId leaf) { return forwards[leaf / 2]; }
};

/// Joins the nodes of `level` (cells ascending, kNoNode left out) up to the root.
NodeId join_top(Stores& stores, int level, std::vector<std::uint32_t> cells,
                std::vector<NodeId> ids) {
  for (; level > 0; --level) {
    std::size_t kept = 0;
    NodeStore::Run run;
    for (std::size_t i = 0; i < cells.size();) {
      const std::uint32_t parent = cells[i] >> 3;
      std::uint32_t words[9] = {};
      int count = 1;
      for (; i < cells.size() && cells[i] >> 3 == parent; ++i) {
        if (ids[i] == kNoNode) continue;
        words[0] |= 1u << (cells[i] & 7);
        words[count++] = ids[i];
      }
      cells[kept] = parent;
      ids[kept++] = count == 1
                        ? kNoNode
                        : stores[level - 1]->intern(words, count, hash_words(words, count), run);
    }
    cells.resize(kept);
    ids.resize(kept);
  }
  return ids.empty() ? kNoNode : ids[0];
}

}  // namespace

BuildResult build_hash_consed(const QuantizedMesh& mesh, int levels, MemoryBudget& budget,
                              Progress* progress) {
  BuildResult result;
  StopWatch watch;
  const SubvolumeBins bins =
      bin_triangles(mesh, levels, subvolume_level(levels, mesh.triangle_count()), budget, progress);
  result.report.quantize_seconds = watch.lap();
  result.report.subvolumes = bins.cells.size();

  Stores stores;
  for (int level = 0; level <= levels - 2; ++level)
    stores.push_back(std::make_unique<NodeStore>(budget));
  const int log2_size = levels - bins.level;
  using Context = SubvolumeContext<DagSink>;
  tbb::enumerable_thread_specific<Context> contexts([&] {
    Context context(mesh, levels, DagSink(stores, kLog2MemoSets));
    budget.add(context.sink.memo.bytes());
    return context;
  });
  std::vector<NodeId> ids(bins.cells.size(), kNoNode);
  std::atomic<std::uint64_t> done{0};
  parallel_for(bins.cells.size(), [&](std::size_t i) {
    if (progress != nullptr && progress->cancelled()) return;
    if (budget.exceeded()) return;
    const Vec3i cell = morton_decode(bins.cells[i]);
    const SubvolumeJob job{
        {cell.x << log2_size, cell.y << log2_size, cell.z << log2_size}, log2_size, bins.list(i)};
    ids[i] = build_subvolume(contexts.local(), job);
    const std::uint64_t finished = done.fetch_add(1, std::memory_order_relaxed) + 1;
    if (progress != nullptr)
      progress->report("voxelize",
                       static_cast<double>(finished) / static_cast<double>(bins.cells.size()));
  });
  if (progress != nullptr) progress->throw_if_cancelled();
  if (budget.exceeded())
    throw_over_memory(budget, static_cast<double>(done.load()) /
                                  static_cast<double>(std::max<std::size_t>(1, bins.cells.size())));
  contexts.clear();
  const NodeId root = join_top(stores, bins.level, bins.cells, std::move(ids));
  result.report.voxelize_seconds = watch.lap();

  result.dag.levels = levels;
  if (root != kNoNode) {
    for (const auto& store : stores) store->release_slots();
    StoreSource source(stores);
    const std::uint64_t copy = source.node_words() * 4 + source.leaf_blocks() * 12;
    budget.add(copy);
    if (budget.exceeded()) throw_over_memory(budget, 1);
    result.dag = canonical_order(source, levels, root);
    budget.remove(source.leaf_blocks() * 4);
  }
  result.report.canonical_seconds = watch.lap();
  result.report.peak_bytes = budget.peak();
  return result;
}

}  // namespace voxdag
