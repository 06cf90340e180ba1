// Depth-first, hash-consed construction (see "From mesh to minimal DAG" in the design).
//
// The sub-volumes are built in parallel into tables that all threads share, so nothing has to be
// merged. The few nodes above them are then built serially.

#include <algorithm>
#include <memory>
#include <vector>

#include "voxdag/builders/dag/build_methods.hpp"
#include "voxdag/builders/dag/join_cells.hpp"
#include "voxdag/builders/dag/stop_watch.hpp"
#include "voxdag/builders/dag/subvolume.hpp"
#include "voxdag/builders/voxelize/duplicate_triangles.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/core/parallel/per_thread.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/core/parallel/thread_count.hpp"
#include "voxdag/stored/svdag/canonical_order.hpp"

namespace voxdag {
namespace {

/// 8 MiB for each thread, less if memory is short.
constexpr int kMaxLog2MemoSets = 16, kMinLog2MemoSets = 10;

using Stores = std::vector<std::unique_ptr<NodeStore>>;

/// Lets the plane memos of all threads take a quarter of the memory that is left.
int log2_memo_sets(const MemoryBudget& budget, std::size_t threads) {
  int log2_sets = kMaxLog2MemoSets;
  while (log2_sets > kMinLog2MemoSets && DagSink::bytes(log2_sets) * threads > budget.left() / 4)
    --log2_sets;
  return log2_sets;
}

/// The stores as the `source` of canonical_order().
struct StoreSource {
  Stores& stores;
  PageVector<std::uint32_t> forwards;  // indexed by half of the leaf's id; ids are even

  StoreSource(Stores& all, MemoryBudget& budget) : stores(all), forwards(&budget) {
    forwards.resize(stores.back()->end_id() / 2);
  }
  const std::uint32_t* words(int level, NodeId id) const { return stores[level]->words(id); }
  std::uint64_t leaf_block(NodeId id) const {
    const std::uint32_t* const words = stores.back()->words(id);
    return words[0] | static_cast<std::uint64_t>(words[1]) << 32;
  }
  std::uint32_t& forward(int level, NodeId id) {
    const bool is_leaf = level + 1 == static_cast<int>(stores.size());
    return is_leaf ? forwards[id / 2] : stores[level]->words(id)[0];
  }
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
};

void measure(const Stores& stores, StageBytes& bytes) {
  // Tables are between 5/16 and 5/8 full.
  constexpr double kSlotBytes = 8 * 2.3;
  std::uint64_t words = 0, nodes = 0;
  for (const auto& store : stores) {
    words += store->word_count();
    nodes += store->node_count();
  }
  const auto leaves = static_cast<double>(stores.back()->node_count());
  const double word_bytes = static_cast<double>(words) * 4;
  bytes.voxelize = word_bytes + static_cast<double>(nodes) * kSlotBytes;
  bytes.number = 2 * word_bytes + leaves * 4;
}

}  // namespace

/// Returns a level whose sub-volumes are small enough to balance the threads, and so large that
/// they seldom cut a triangle.
int hash_bin_level(int levels, std::size_t triangles) {
  int level = std::clamp(levels - 5, 0, 6);
  // About 1024 triangles for each of the ~4^level cells of a surface.
  while (level < levels - 2 && level < 10 && (triangles >> (2 * level)) > 1024) ++level;
  // The recursion goes down two levels at a time.
  if ((levels - level) % 2 != 0) level += level > 0 ? -1 : 1;
  return level;
}

HashConsedNodes voxelize_hash_consed(const BuildInput& input, BuildReport& report,
                                     StageBytes& bytes) {
  StopWatch watch;
  const BinnedMesh binned = bin_mesh(input);
  report.quantize_seconds = watch.lap();
  return voxelize_binned(binned, input.grid.levels, input.work, report, bytes);
}

HashConsedNodes voxelize_binned(const BinnedMesh& binned, int levels, Work work,
                                BuildReport& report, StageBytes& bytes) {
  StopWatch watch;
  const SubvolumeBins& bins = binned.bins;
  report.subvolumes = bins.cells.size();
  const std::size_t threads = thread_count(bins.cells.size());
  const int log2_sets = log2_memo_sets(*work.memory, threads);
  bytes.prepare = binned.prepare_bytes;
  bytes.voxelize_fixed =
      static_cast<double>(work.memory->used()) +
      static_cast<double>(threads) *
          (static_cast<double>(DagSink::bytes(log2_sets)) + list_scratch_bytes(bins));

  HashConsedNodes result;
  for (int level = 0; level <= levels - 2; ++level)
    result.stores.push_back(std::make_unique<NodeStore>(*work.memory));
  const int log2_size = levels - bins.level;
  using Context = SubvolumeContext<DagSink>;
  PerThread<Context> contexts([&] {
    return Context(binned.mesh, levels, DagSink(result.stores, log2_sets, *work.memory), work);
  });
  std::vector<NodeId> ids(bins.cells.size(), kNoNode);
  polled_for(bins.cells.size(), 1, work, "voxelize", [&](std::size_t i) {
    const Vec3i cell = morton_decode(bins.cells[i]);
    const SubvolumeJob job{
        {cell.x << log2_size, cell.y << log2_size, cell.z << log2_size}, log2_size, bins.list(i)};
    ids[i] = build_subvolume(contexts.local(), job);
  });
  std::vector<NodeStore::Run> runs(result.stores.size());
  result.root = join_cells(bins.level, {bins.cells.begin(), bins.cells.end()}, std::move(ids),
                           [&](int level, const std::uint32_t* words, int count) {
                             return result.stores[level]->intern(
                                 words, count, hash_words(words, count), runs[level]);
                           });
  measure(result.stores, bytes);
  report.voxelize_seconds = watch.lap();
  return result;
}

Svdag number_nodes(HashConsedNodes nodes, int levels, Work work, BuildReport& report) {
  Svdag dag;
  dag.levels = levels;
  if (nodes.root == kNoNode) return dag;
  StopWatch watch;
  for (const auto& store : nodes.stores) store->release_slots();
  StoreSource source(nodes.stores, *work.memory);
  dag = canonical_order(source, levels, nodes.root, work);
  report.canonical_seconds = watch.lap();
  return dag;
}

Svdag build_range(CountedVector<QuantizedTriangle> triangles, int levels, const CellRange& range,
                  Work work) {
  MemoryBudget unlimited;
  if (work.memory == nullptr) work.memory = &unlimited;
  const int bin_level = std::max(hash_bin_level(levels, triangles.size()), range.level);
  BuildReport report;
  StageBytes bytes;
  QuantizedMesh mesh(std::move(triangles));
  const IndexSet duplicates = find_duplicate_triangles(mesh, work);
  SubvolumeBins bins = bin_triangles(mesh, levels, bin_level, range, duplicates, work);
  const BinnedMesh binned{std::move(mesh), std::move(bins), 0};
  return number_nodes(voxelize_binned(binned, levels, work, report, bytes), levels, work, report);
}

}  // namespace voxdag
