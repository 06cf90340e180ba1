#include "voxdag/stored/compact/encode_svdag.hpp"

#include <algorithm>
#include <bit>
#include <optional>

#include "voxdag/stored/compact/compact_model.hpp"
#include "voxdag/stored/compact/encoded_records.hpp"
#include "voxdag/stored/compact/symbol_batch.hpp"
#include "voxdag/stored/compact/unit_symbols.hpp"

namespace voxdag {
namespace {

/// Returns the voxels of `dag`, whose grid has fewer than 16³, in the corner of a grid of 16³.
Svdag in_corner(const SvdagView& dag) {
  Svdag out;
  out.levels = 4;
  const int missing = 4 - dag.levels;
  // Each new node has one child, which is the node after it or the old root.
  for (int level = 0; level < missing; ++level) {
    out.level_begin[static_cast<std::size_t>(level)] = out.nodes.size();
    const bool above_leaf_blocks = level == 1;
    out.nodes.push_back(1);
    out.nodes.push_back(above_leaf_blocks ? 0 : static_cast<std::uint32_t>(out.nodes.size()) + 1);
  }
  if (dag.levels == 3) {
    out.level_begin[1] = 2;
    out.nodes.insert(out.nodes.end(), dag.nodes, dag.nodes + dag.node_words());
  }
  out.leaf_blocks.assign(dag.leaf_blocks, dag.leaf_blocks + dag.leaf_block_count);
  std::fill(out.level_begin.begin() + 2, out.level_begin.end(), out.nodes.size());
  return out;
}

/// The intervals of the symbols of one tree's tables.
class Intervals {
 public:
  explicit Intervals(const ContextTree& tree) : of_(tree.tables()) {
    for (std::size_t t = 0; t < tree.tables(); ++t) of_[t] = intervals_of(tree.weights[t]);
  }
  SymbolInterval of(std::uint32_t table, std::uint32_t symbol) const { return of_[table][symbol]; }

 private:
  std::vector<std::array<SymbolInterval, 256>> of_;
};

/// Writes the records of one task.
class RecordWriter {
 public:
  RecordWriter(const std::vector<Intervals>& intervals, const TableFinder& finder)
      : intervals_(&intervals), batch_(finder) {}

  void symbol(CompactSymbol symbol, std::uint64_t features, std::uint32_t value) {
    batch_.symbol(symbol, features, value);
  }
  void raw(std::uint32_t value, int count) { batch_.raw(value, count); }

  /// Appends the record of the symbols so far to `bits`, closed.
  void close() {
    put_symbols();
    coder_.close(bits);
  }
  /// Appends the record of the symbols so far to `bits`, open.
  void leave_open() {
    put_symbols();
    coder_.leave_open(bits);
  }

  /// Adds a symbol whose table is known.
  void put(const BatchedSymbol& symbol) {
    if (symbol.kind == BatchedSymbol::kRaw) {
      coder_.put_raw(symbol.value, symbol.bits);
      return;
    }
    const SymbolInterval interval = (*intervals_)[symbol.kind].of(symbol.table, symbol.value);
    coder_.put(interval.start, interval.frequency);
  }

  BitWriter bits;

 private:
  void put_symbols() {
    batch_.flush([&](const BatchedSymbol& symbol) { put(symbol); });
  }

  const std::vector<Intervals>* intervals_;
  SymbolBatch batch_;
  SymbolWriter coder_;
};

class Encoder {
 public:
  Encoder(const SvdagView& dag, const CompactOptions& options, Work work)
      : nodes_(dag, work), work_(work), shared_bricks_(work.memory) {
    trees_ = choose_trees(nodes_, options.tables, work, coded_);
    finder_.emplace(trees_);
    for (const ContextTree& tree : trees_) intervals_.emplace_back(tree);
    for (int level = 0; level <= nodes_.unit_level(); ++level) {
      records_.emplace_back(work_.memory);
      subtree_bits_.emplace_back(work_.memory);
    }
  }

  CompactSvdag encode() {
    write_bricks();
    choose_unit_bits();
    for (int level = nodes_.unit_level() - 1; level >= 0; --level) write_level(level);
    return assemble();
  }

 private:
  static std::size_t at(int level) { return static_cast<std::size_t>(level); }
  RecordWriter writer() const { return {intervals_, *finder_}; }

  void write_bricks() {
    const auto& bricks = nodes_.shared(nodes_.brick_level());
    const int level = nodes_.unit_level();
    const auto& units = nodes_.nodes(level);
    const auto put_kept = [&](std::size_t i, RecordWriter& out) {
      coded_.visit(i, [&](const BatchedSymbol& symbol) { out.put(symbol); });
    };
    shared_bricks_.write(
        bricks.size(), work_, [&] { return writer(); },
        [&](std::size_t i, RecordWriter& out) {
          if (coded_.are_kept())
            put_kept(units.size() + i, out);
          else
            visit_shared_brick(nodes_, bricks[i], out);
          out.close();
        });
    records_[at(level)].write(
        units.size(), work_, [&] { return writer(); },
        [&](std::size_t i, RecordWriter& out) {
          if (coded_.are_kept())
            put_kept(i, out);
          else
            visit_unit(nodes_, units[i], out);
          out.close();
        });
    coded_.clear();
    subtree_bits_[at(level)].resize(units.size());
    for (std::size_t i = 0; i < units.size(); ++i)
      subtree_bits_[at(level)][i] = records_[at(level)].bits(i);
  }

  /// Calls visit(index, pointer, inline_left) for the inline children of the node at `word` whose
  /// lengths are stored, which are all but the last. `inline_left` counts the inline children from
  /// this one on.
  template <class Visit>
  void for_each_length(std::uint32_t word, const Visit& visit) const {
    const std::uint32_t* node = nodes_.dag().nodes + word;
    int left = 0;
    for (int i = 1; i <= popcount(node[0]); ++i) left += nodes_.is_shared(node[i]) ? 0 : 1;
    for (int i = 0; i < 8; ++i) {
      if ((node[0] >> i & 1u) == 0 || nodes_.is_shared(child_pointer(node, i))) continue;
      if (left == 1) break;
      visit(i, child_pointer(node, i), left--);
    }
  }

  /// Chooses the frequencies of the lengths of units.
  void choose_unit_bits() {
    const int level = nodes_.unit_level() - 1;
    if (level >= 0) {
      ContextTree& tree = trees_[kUnitBits];
      SymbolCounts counts(tree.tables());
      for (const std::uint32_t word : nodes_.nodes(level))
        for_each_length(word, [&](int, std::uint32_t pointer, int) {
          counts.add(0, static_cast<std::uint32_t>(std::bit_width(bits_below(level, pointer))));
        });
      counts.set_frequencies(tree);
    }
    intervals_[kUnitBits] = Intervals(trees_[kUnitBits]);
  }

  /// Returns the bits of an inline child of a node of `level`, with all that is inline below it.
  std::uint64_t bits_below(int level, std::uint32_t pointer) const {
    return subtree_bits_[at(level + 1)][nodes_.position(pointer)];
  }

  void write_level(int level) {
    const auto& words = nodes_.nodes(level);
    records_[at(level)].write(
        words.size(), work_, [&] { return writer(); },
        [&](std::size_t i, RecordWriter& out) { write_node(words[i], level, out); });
    auto& bits = subtree_bits_[at(level)];
    bits.resize(words.size());
    parallel_for(words.size(), 1024, [&](std::size_t i) {
      const std::uint32_t* node = nodes_.dag().nodes + words[i];
      bits[i] = records_[at(level)].bits(i);
      for (int c = 1; c <= popcount(node[0]); ++c)
        if (!nodes_.is_shared(node[c])) bits[i] += bits_below(level, node[c]);
    });
  }

  void write_node(std::uint32_t word, int level, RecordWriter& out) const {
    const std::uint32_t* node = nodes_.dag().nodes + word;
    std::uint8_t kinds[8];
    visit_node(nodes_, word, level, out, kinds);
    const bool above_units = level + 1 == nodes_.unit_level();
    std::uint64_t lengths[8] = {};
    bool has_length[8] = {};
    for_each_length(word, [&](int i, std::uint32_t pointer, int left) {
      has_length[i] = true;
      lengths[i] = bits_below(level, pointer);
      if (above_units)
        out.symbol(kUnitBits, unit_features(node[0], i, left),
                   static_cast<std::uint32_t>(std::bit_width(lengths[i])));
    });
    out.leave_open();
    for (int i = 0; i < 8; ++i) {
      if (kinds[i] != 0) {
        const std::uint64_t number =
            std::uint64_t{nodes_.shared_number(child_pointer(node, i))} + 1;
        out.bits.put_long(number ^ std::uint64_t{1} << (kinds[i] - 1), kinds[i] - 1);
      } else if (has_length[i]) {
        const auto bits = static_cast<int>(std::bit_width(lengths[i]));
        if (!above_units) out.bits.put_long(static_cast<std::uint64_t>(bits), 6);
        if (bits > 1) out.bits.put_long(lengths[i] ^ std::uint64_t{1} << (bits - 1), bits - 1);
      }
    }
  }

  CompactSvdag assemble() {
    CompactSvdag compact;
    compact.levels = nodes_.dag().levels;
    compact.brick_first = nodes_.brick_first();
    std::uint64_t total = 0;
    for (int level = 0; level <= nodes_.unit_level(); ++level)
      for (const std::uint32_t i : nodes_.shared(level)) total += subtree_bits_[at(level)][i];
    const auto& bricks = nodes_.shared(nodes_.brick_level());
    for (std::size_t i = 0; i < bricks.size(); ++i) total += shared_bricks_.bits(i);
    const MemoryReservation stream(work_.memory, stream_words(total) * 4);

    BitWriter out;
    out.reserve(total);
    compact.shared_begin.clear();
    for (int level = 0; level <= nodes_.brick_level(); ++level) {
      const auto& shared = nodes_.shared(level);
      compact.shared_counts.push_back(shared.size());
      for (std::size_t i = 0; i < shared.size(); ++i) {
        work_.poll_seldom(i);
        compact.shared_begin.push_back(out.bits());
        if (level == nodes_.brick_level()) {
          shared_bricks_.copy(i, out);
        } else {
          copy_subtree(level, shared[i], out);
        }
      }
    }
    compact.stream_bits = out.bits();
    compact.shared_begin.push_back(out.bits());
    compact.stream = out.finish();
    for (std::size_t i = 0; i < trees_.size(); ++i) compact.trees[i] = std::move(trees_[i]);
    return compact;
  }

  void copy_subtree(int level, std::uint32_t position, BitWriter& out) const {
    records_[at(level)].copy(position, out);
    if (level == nodes_.unit_level()) return;
    const std::uint32_t* node = nodes_.dag().nodes + nodes_.nodes(level)[position];
    for (int i = 1; i <= popcount(node[0]); ++i)
      if (!nodes_.is_shared(node[i])) copy_subtree(level + 1, nodes_.position(node[i]), out);
  }

  NumberedNodes nodes_;
  Work work_;
  CodedSymbols coded_;
  CompactTrees trees_;
  std::optional<TableFinder> finder_;
  std::vector<Intervals> intervals_;
  EncodedRecords shared_bricks_;
  std::vector<EncodedRecords> records_;  ///< Of levels 0 to C-4.
  std::vector<CountedVector<std::uint64_t>> subtree_bits_;
};

}  // namespace

CompactSvdag encode_svdag(const SvdagView& dag, const CompactOptions& options, Work work) {
  CompactSvdag compact;
  if (dag.is_empty()) {
    compact.levels = dag.levels;
    for (ContextTree& tree : compact.trees) tree.prepare();
    return compact;
  }
  if (dag.levels >= 4) return Encoder(dag, options, work).encode();
  const Svdag deeper = in_corner(dag);
  compact = Encoder(deeper.view(), options, work).encode();
  compact.levels = dag.levels;
  return compact;
}

}  // namespace voxdag
