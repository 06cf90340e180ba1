#include "voxdag/stored/compact/compact_model.hpp"

#include <algorithm>

#include "voxdag/core/parallel/per_thread.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/stored/compact/train_tree.hpp"
#include "voxdag/stored/compact/unit_symbols.hpp"

namespace voxdag {
namespace {

/// About this many bricks are samples for the trees.
constexpr std::uint64_t kSampledBricks = 40000;

/// Returns whether the item is a sample. About one in `stride` items is a sample, at irregular
/// distances.
bool is_sample(std::uint64_t item, std::uint64_t stride) {
  std::uint64_t x = item * 0x9E3779B97F4A7C15ull;
  x = (x ^ x >> 32) * 0xD6E8FEB86659FD93ull;
  return (x >> 32) % stride == 0;
}

class SampleSink {
 public:
  void symbol(CompactSymbol symbol, std::uint64_t features, std::uint32_t value) {
    samples[symbol].push_back({features, value});
  }
  void raw(std::uint32_t, int) {}

  std::array<std::vector<ContextSample>, kCompactSymbols> samples;
};

/// Counts symbols, and keeps them if there is a part of CodedSymbols for them.
class CountSink {
 public:
  CountSink(const CompactTrees& trees, const TableFinder& finder) : batch_(finder) {
    for (const ContextTree& tree : trees) counts_.emplace_back(tree.tables());
  }
  void symbol(CompactSymbol symbol, std::uint64_t features, std::uint32_t value) {
    batch_.symbol(symbol, features, value);
    if (batch_.size() >= kBatch) count();
    ++words_;
  }
  void raw(std::uint32_t value, int bits) {
    if (kept_ != nullptr) batch_.raw(value, bits);
    words_ += 2;
  }

  /// Starts a part. `kept`, which may be null, gets its symbols.
  void begin(CodedSymbols::Part* kept) {
    kept_ = kept;
    words_ = 0;
  }
  /// Ends the symbols of a node of the part.
  void end_node() {
    if (kept_ != nullptr) kept_->ends.push_back(words_);
  }
  /// Counts the symbols of the batch. The last call of a part counts its last symbols.
  void count() {
    batch_.flush([&](const BatchedSymbol& symbol) {
      if (symbol.kind != BatchedSymbol::kRaw) counts_[symbol.kind].add(symbol.table, symbol.value);
      if (kept_ != nullptr) kept_->put(symbol);
    });
  }

  const std::vector<SymbolCounts>& counts() const { return counts_; }

 private:
  static constexpr std::size_t kBatch = 1024;

  SymbolBatch batch_;
  std::vector<SymbolCounts> counts_;
  CodedSymbols::Part* kept_ = nullptr;
  std::uint32_t words_ = 0;  ///< Words of the symbols since begin().
};

/// The nodes that have symbols, in one sequence: units, shared bricks, nodes above the units.
class AllNodes {
 public:
  explicit AllNodes(const NumberedNodes& nodes) : nodes_(nodes) {
    parts_.push_back(nodes.nodes(nodes.unit_level()).size());
    parts_.push_back(nodes.shared(nodes.brick_level()).size());
    for (int level = 0; level < nodes.unit_level(); ++level)
      parts_.push_back(nodes.nodes(level).size());
    for (const std::uint64_t part : parts_) size_ += part;
  }
  std::uint64_t size() const { return size_; }

  template <class Sink>
  void visit(std::uint64_t i, Sink& sink) const {
    std::size_t part = 0;
    for (; i >= parts_[part]; ++part) i -= parts_[part];
    if (part == 0) {
      visit_unit(nodes_, nodes_.nodes(nodes_.unit_level())[i], sink);
    } else if (part == 1) {
      visit_shared_brick(nodes_, nodes_.shared(nodes_.brick_level())[i], sink);
    } else {
      const int level = static_cast<int>(part) - 2;
      std::uint8_t kinds[8];
      visit_node(nodes_, nodes_.nodes(level)[i], level, sink, kinds);
    }
  }

 private:
  const NumberedNodes& nodes_;
  std::vector<std::uint64_t> parts_;
  std::uint64_t size_ = 0;
};

std::uint64_t count_bricks(const NumberedNodes& nodes) {
  const SvdagView& dag = nodes.dag();
  const int level = nodes.brick_level();
  // Most bricks have two to six leaves, which is precise enough for a number of samples.
  return (dag.level_begin[level + 1] - dag.level_begin[level]) / 5 + 1;
}

}  // namespace

void SymbolCounts::set_frequencies(ContextTree& tree) const {
  for (std::size_t t = 0; t < counts_.size(); ++t) {
    std::uint64_t most = 0;
    for (const std::uint64_t count : counts_[t]) most = std::max(most, count);
    int shift = 0;
    while (most >> shift >= 1u << 24) ++shift;
    std::array<std::uint32_t, 256> scaled{};
    for (std::size_t s = 0; s < 256; ++s)
      if (counts_[t][s] != 0)
        scaled[s] = std::max(static_cast<std::uint32_t>(counts_[t][s] >> shift), 1u);
    tree.weights[t] = weights_for(scaled);
  }
  tree.prepare();
}

CompactTrees choose_trees(const NumberedNodes& nodes, int most_tables, Work work,
                          CodedSymbols& coded) {
  const AllNodes all(nodes);
  const std::uint64_t stride = std::max<std::uint64_t>(count_bricks(nodes) / kSampledBricks, 1);
  SampleSink samples;
  // About 30 symbols a brick; vectors grow by doubling.
  const std::uint64_t sampled_bricks = std::min(count_bricks(nodes) * 5, 2 * kSampledBricks);
  const MemoryReservation sampled(work.memory, 2 * sampled_bricks * 30 * sizeof(ContextSample));
  for (std::uint64_t i = 0; i < all.size(); ++i) {
    work.poll_seldom(i);
    if (is_sample(i, stride)) all.visit(i, samples);
  }
  CompactTrees trees;
  parallel_for(kCompactSymbols, [&](std::size_t symbol) {
    const auto s = static_cast<CompactSymbol>(symbol);
    const int share = s == kCellMask ? 1 : s == kLeafMask ? 2 : 8;
    const TreeLimits limits{kCompactFeatures[s], std::max(most_tables / share, 1), stride};
    trees[s] = train_tree(samples.samples[s], limits, work);
    samples.samples[s] = {};
  });

  std::size_t tables = 0;
  for (const ContextTree& tree : trees) tables += tree.tables();
  const TableFinder finder(trees);
  PerThread<CountSink> sinks([&] { return CountSink(trees, finder); });
  const MemoryReservation counted(work.memory, tables * 256 * sizeof(std::uint64_t) * 3);
  // A brick has about 35 symbols.
  coded.begin(all.size(), count_bricks(nodes) * 35, work.memory);
  constexpr std::size_t kPart = CodedSymbols::kPart;
  polled_for((all.size() + kPart - 1) / kPart, 1, work, "model", [&](std::size_t part) {
    CountSink& sink = sinks.local();
    CodedSymbols::Part* const kept = coded.are_kept() ? &coded.part(part) : nullptr;
    sink.begin(kept);
    for (std::uint64_t i = part * kPart;
         i < std::min<std::uint64_t>(all.size(), (part + 1) * kPart); ++i) {
      all.visit(i, sink);
      sink.end_node();
    }
    sink.count();
    if (kept != nullptr) kept->memory = MemoryReservation(work.memory, kept->bytes());
  });
  for (std::size_t s = 0; s < trees.size(); ++s) {
    SymbolCounts sum(trees[s].tables());
    for (const CountSink& sink : sinks) sum.add(sink.counts()[s]);
    sum.set_frequencies(trees[s]);
  }
  return trees;
}

}  // namespace voxdag
