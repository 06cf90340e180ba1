#include "voxdag/stored/compact/compact_bytes.hpp"

#include <algorithm>
#include <memory>
#include <string>

#include "voxdag/core/bits.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/stored/compact/adaptive_bits.hpp"

namespace voxdag {
namespace {

constexpr std::uint64_t kLongLength = 255;

/// Writes and reads the shape of a tree, depth first: whether a node is inner, and which feature it
/// tests.
struct TreeShape {
  AdaptiveBit is_inner;
  AdaptiveNumber<6> feature;

  void put(AdaptiveBitWriter& out, const ContextTree& tree, std::uint32_t node) {
    const std::uint32_t word = tree.nodes[node];
    const bool inner = (word & kLeafNode) == 0;
    out.put(inner, is_inner);
    if (!inner) return;
    feature.put(out, word & 63u);
    put(out, tree, word >> 8);
    put(out, tree, (word >> 8) + 1);
  }

  ContextTree get(AdaptiveBitReader& in, std::uint32_t features) {
    ContextTree tree;
    tree.weights.clear();
    get(in, features, tree, 0);
    return tree;
  }

 private:
  void get(AdaptiveBitReader& in, std::uint32_t features, ContextTree& tree, std::size_t node) {
    if (!in.get(is_inner)) {
      tree.nodes[node] = static_cast<std::uint32_t>(tree.tables()) << 8 | kLeafNode;
      tree.weights.emplace_back();
      return;
    }
    const std::uint32_t tested = feature.get(in);
    if (tested >= features) throw Error("", "", "tests a feature that does not exist");
    const std::size_t children = tree.nodes.size();
    if (children / 2 + 1 >= kMaxTables || in.is_past_end())
      throw Error("", "", "has too many nodes");
    tree.nodes[node] = static_cast<std::uint32_t>(children) << 8 | tested;
    tree.nodes.resize(children + 2);
    get(in, features, tree, children);
    get(in, features, tree, children + 1);
  }
};

/// Writes and reads the weights of tables. A weight is coded in the context of the same symbol's
/// weight in the table before.
class TableWeights {
 public:
  void put(AdaptiveBitWriter& out, const WeightCodes& weights, std::uint32_t alphabet) {
    for (std::uint32_t s = 0; s < alphabet; ++s) {
      const std::size_t before = group(before_[s]);
      out.put(weights[s] != 0, occurs_[s][before]);
      if (weights[s] != 0) codes_[before].put(out, weights[s]);
    }
    before_ = weights;
  }
  void get(AdaptiveBitReader& in, WeightCodes& weights, std::uint32_t alphabet) {
    for (std::uint32_t s = 0; s < alphabet; ++s) {
      const std::size_t before = group(before_[s]);
      if (!in.get(occurs_[s][before])) continue;
      const std::uint32_t code = codes_[before].get(in);
      if (code == 0 || code > kMaxWeightCode)
        throw Error("", "", "has a weight that does not exist");
      weights[s] = static_cast<std::uint8_t>(code);
    }
    before_ = weights;
  }

 private:
  static constexpr std::size_t kGroups = 7;
  /// Returns 0 for code 0, 1 for 1 to 4, 2 for 5 to 12, and so on in steps of 8.
  static constexpr std::size_t group(std::uint8_t code) {
    return code == 0 ? 0 : code <= 4 ? 1 : (code + 11u) / 8u;
  }

  AdaptiveBit occurs_[256][kGroups + 1];
  AdaptiveNumber<6> codes_[kGroups + 1];
  WeightCodes before_{};
};

/// Writes and reads the lengths of shared nodes.
class SharedLengths {
 public:
  /// `set`: 0 for nodes above the units, 1 for units, 1 + the number of leaves for bricks.
  void put(AdaptiveBitWriter& out, std::uint64_t length, std::size_t set) {
    if (set != 0) {
      short_[set].put(out, static_cast<std::uint32_t>(std::min(length, kLongLength)));
      if (length < kLongLength) return;
    }
    long_.put(out, length);
  }
  std::uint64_t get(AdaptiveBitReader& in, std::size_t set) {
    if (set != 0) {
      const std::uint32_t length = short_[set].get(in);
      if (length < kLongLength) return length;
    }
    return long_.get(in);
  }

 private:
  AdaptiveNumber<8> short_[10];
  AdaptiveCount long_;
};

std::size_t length_set(int level, int coded_levels, std::uint32_t brick_mask) {
  if (level < coded_levels - 4) return 0;
  return level == coded_levels - 4 ? 1 : static_cast<std::size_t>(1 + popcount8(brick_mask));
}

std::string tree_name(int tree) { return "tree " + std::to_string(tree); }

int coded_levels_of(int levels) { return std::max(levels, 4); }

}  // namespace

std::vector<std::byte> compact_head(const CompactSvdag& compact) {
  if (compact.is_empty()) return {};
  AdaptiveBitWriter out;
  AdaptiveCount count;
  const int coded_levels = coded_levels_of(compact.levels);
  for (const std::uint64_t shared : compact.shared_counts) count.put(out, shared);
  for (std::size_t m = 1; m < 256; ++m)
    count.put(out, compact.brick_first[m + 1] - compact.brick_first[m]);
  for (int i = 0; i < kCompactSymbols; ++i) TreeShape().put(out, compact.trees[i], 0);
  for (int i = 0; i < kCompactSymbols; ++i) {
    const auto weights = std::make_unique<TableWeights>();
    for (const WeightCodes& table : compact.trees[i].weights)
      weights->put(out, table, kCompactAlphabet[i]);
  }
  const auto lengths = std::make_unique<SharedLengths>();
  std::size_t node = 0;
  for (int level = 0; level <= coded_levels - 3; ++level) {
    std::uint32_t mask = 0;
    for (std::uint64_t n = 0; n < compact.shared_counts[static_cast<std::size_t>(level)];
         ++n, ++node) {
      if (level == coded_levels - 3)
        while (compact.brick_first[mask + 1] <= n) ++mask;
      lengths->put(out, compact.shared_begin[node + 1] - compact.shared_begin[node],
                   length_set(level, coded_levels, mask));
    }
  }
  return out.finish();
}

CompactSvdag parse_compact_head(std::span<const std::byte> head, int levels,
                                std::uint64_t stream_words) {
  CompactSvdag compact;
  compact.levels = levels;
  if (head.empty()) {
    if (stream_words != 0) throw Error("", "stream", "has words, but the DAG has no voxels");
    for (ContextTree& tree : compact.trees) tree.prepare();
    return compact;
  }
  if (stream_words < 2) throw Error("", "stream", "is too short");
  const int coded_levels = coded_levels_of(levels);
  const std::uint64_t most_bits = stream_words * 32;
  AdaptiveBitReader in(head);
  AdaptiveCount count;
  // Shared nodes differ, so that at most one of each kind has no bits.
  const std::uint64_t most_shared = most_bits + 512;
  std::uint64_t shared = 0;
  const auto get_count = [&] {
    const std::uint64_t n = count.get(in);
    if (n > most_shared || in.is_past_end())
      throw Error("", "shared nodes", "are more than the stream can hold");
    return n;
  };
  for (int level = 0; level <= coded_levels - 3; ++level) {
    compact.shared_counts.push_back(get_count());
    shared += compact.shared_counts.back();
  }
  if (compact.shared_counts[0] != 1) throw Error("", "shared nodes", "level 0 must have one node");
  if (shared > most_shared) throw Error("", "shared nodes", "are more than the stream can hold");
  for (std::size_t m = 1; m < 256; ++m)
    compact.brick_first[m + 1] = compact.brick_first[m] + get_count();
  if (compact.brick_first[256] != compact.shared_counts.back())
    throw Error("", "shared nodes", "the numbers of bricks by mask do not add up");

  for (int i = 0; i < kCompactSymbols; ++i) {
    try {
      compact.trees[i] = TreeShape().get(in, static_cast<std::uint32_t>(kCompactFeatures[i]));
    } catch (const Error& error) {
      throw Error("", tree_name(i), error.reason());
    }
  }
  for (int i = 0; i < kCompactSymbols; ++i) {
    const auto weights = std::make_unique<TableWeights>();
    for (std::size_t t = 0; t < compact.trees[i].tables(); ++t) {
      try {
        weights->get(in, compact.trees[i].weights[t], kCompactAlphabet[i]);
        if (in.is_past_end()) throw Error("", "", "is truncated");
      } catch (const Error& error) {
        throw Error("", "table " + std::to_string(t) + " of " + tree_name(i), error.reason());
      }
    }
    compact.trees[i].prepare();
  }

  const auto lengths = std::make_unique<SharedLengths>();
  compact.shared_begin.clear();
  compact.shared_begin.reserve(shared + 1);
  for (int level = 0; level <= coded_levels - 3; ++level) {
    std::uint32_t mask = 0;
    for (std::uint64_t n = 0; n < compact.shared_counts[static_cast<std::size_t>(level)]; ++n) {
      if (level == coded_levels - 3)
        while (compact.brick_first[mask + 1] <= n) ++mask;
      compact.shared_begin.push_back(compact.stream_bits);
      const std::uint64_t length = lengths->get(in, length_set(level, coded_levels, mask));
      if (length > most_bits - compact.stream_bits || in.is_past_end())
        throw Error("", "shared nodes", "are longer than the stream");
      compact.stream_bits += length;
    }
  }
  compact.shared_begin.push_back(compact.stream_bits);
  if (!in.is_at_end()) throw Error("", "shared nodes", "bytes follow the last length");
  if (voxdag::stream_words(compact.stream_bits) != stream_words)
    throw Error("", "stream",
                "has " + std::to_string(stream_words) + " words, but the head says " +
                    std::to_string(voxdag::stream_words(compact.stream_bits)));
  return compact;
}

}  // namespace voxdag
