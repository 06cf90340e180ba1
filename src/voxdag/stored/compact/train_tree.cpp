#include "voxdag/stored/compact/train_tree.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <memory>

#include "voxdag/core/parallel/polled_for.hpp"

namespace voxdag {
namespace {

constexpr int kFraction = 16;  ///< Fractional bits of costs.

/// Table of log2(1 + i / 2^kLogBits) with kFraction fractional bits, by repeated squaring.
constexpr int kLogBits = 10;
constexpr auto kLogs = [] {
  std::array<std::uint32_t, (1 << kLogBits) + 1> logs{};
  for (std::uint64_t i = 0; i < logs.size(); ++i) {
    std::uint64_t x = (std::uint64_t{1} << 31) + (i << (31 - kLogBits));  // 1.31 bits
    std::uint32_t log = 0;
    if (x >> 32 != 0) {
      log = 1u << kFraction;
    } else {
      for (int bit = kFraction - 1; bit >= 0; --bit) {
        x = x * x >> 31;
        if (x >> 32 == 0) continue;
        x >>= 1;
        log |= 1u << bit;
      }
    }
    logs[i] = log;
  }
  return logs;
}();

std::uint64_t n_log_n_of(std::uint64_t n) {
  if (n < 2) return 0;
  const int top = static_cast<int>(std::bit_width(n)) - 1;
  // The bits below the leading one, of which the table takes the highest.
  const std::uint64_t below = (n << (63 - top)) << 1;
  const std::uint64_t i = below >> (64 - kLogBits), rest = below << kLogBits >> 32;
  const std::uint64_t log = (static_cast<std::uint64_t>(top) << kFraction) + kLogs[i] +
                            ((kLogs[i + 1] - kLogs[i]) * rest >> 32);
  return n * log;
}

/// Returns n log2(n), with kFraction fractional bits.
std::uint64_t n_log_n(std::uint64_t n) {
  static const std::array<std::uint32_t, 4096> kSmall = [] {
    std::array<std::uint32_t, 4096> values{};
    for (std::uint32_t i = 0; i < values.size(); ++i)
      values[i] = static_cast<std::uint32_t>(n_log_n_of(i));
    return values;
  }();
  return n < kSmall.size() ? kSmall[n] : n_log_n_of(n);
}

constexpr std::int64_t bits(std::int64_t n) { return n << kFraction; }
/// The cost of a symbol in a table of frequencies, and of a table and its node, as measured.
constexpr std::int64_t kSymbolCost = bits(6), kTableCost = bits(60);
constexpr std::size_t kMinSamples = 32;

struct Leaf {
  std::uint32_t node = 0;  ///< Its index among the growing nodes.
  std::size_t begin = 0, end = 0;
  std::int64_t gain = 0;  ///< Of the best split.
  int feature = -1;       ///< Of the best split; -1: none saves bits.
};

struct GrowingNode {
  int feature = -1;
  std::uint32_t children[2] = {};
};

class TreeGrower {
 public:
  TreeGrower(std::span<ContextSample> samples, const TreeLimits& limits, Work work)
      : samples_(samples), limits_(limits), work_(work) {
    for (auto& counts : counts_) counts = std::make_unique<Counts>();
  }

  ContextTree grow() {
    nodes_.push_back({});
    std::vector<Leaf> leaves{{0, 0, samples_.size(), 0, -1}};
    find_split(leaves[0], *counts_[0]);
    // Splits the leaf with the largest gain; the first of equals.
    const auto less = [&](const Leaf& a, const Leaf& b) {
      return a.gain != b.gain ? a.gain < b.gain : a.node > b.node;
    };
    for (int tables = 1; tables < limits_.tables && !leaves.empty(); ++tables) {
      work_.poll();
      std::pop_heap(leaves.begin(), leaves.end(), less);
      const Leaf leaf = leaves.back();
      leaves.pop_back();
      if (leaf.feature < 0) break;
      const auto middle = std::partition(at(leaf.begin), at(leaf.end), [&](const ContextSample& s) {
        return (s.features >> leaf.feature & 1) == 0;
      });
      const auto split = static_cast<std::size_t>(middle - samples_.begin());
      Leaf halves[2] = {{static_cast<std::uint32_t>(nodes_.size()), leaf.begin, split, 0, -1},
                        {static_cast<std::uint32_t>(nodes_.size()) + 1, split, leaf.end, 0, -1}};
      nodes_[leaf.node] = {leaf.feature, {halves[0].node, halves[1].node}};
      nodes_.resize(nodes_.size() + 2);
      if (leaf.end - leaf.begin > 4096) {
        parallel_for(2, [&](std::size_t i) { find_split(halves[i], *counts_[i]); });
      } else {
        for (Leaf& half : halves) find_split(half, *counts_[0]);
      }
      for (const Leaf& half : halves) {
        leaves.push_back(half);
        std::push_heap(leaves.begin(), leaves.end(), less);
      }
    }
    ContextTree tree;
    tree.nodes.assign(1, 0);
    tree.weights.clear();
    place(0, 0, tree);
    return tree;
  }

 private:
  using Histogram = std::array<std::uint32_t, 256>;
  struct Counts {
    std::array<Histogram, 64> ones;  ///< Of the samples that have the feature.
  };

  std::span<ContextSample>::iterator at(std::size_t i) const {
    return samples_.begin() + static_cast<std::ptrdiff_t>(i);
  }

  /// Finds the feature that saves the most bits. O(samples * features that are set).
  void find_split(Leaf& leaf, Counts& counts) const {
    if (leaf.end - leaf.begin < kMinSamples) return;
    Histogram all{};
    for (std::size_t i = leaf.begin; i != leaf.end; ++i) ++all[samples_[i].symbol];
    std::array<std::uint32_t, 256> present;
    std::size_t symbols = 0;
    for (std::uint32_t s = 0; s < 256; ++s)
      if (all[s] != 0) present[symbols++] = s;
    if (symbols < 2) return;
    for (int f = 0; f < limits_.features; ++f)
      for (std::size_t k = 0; k < symbols; ++k)
        counts.ones[static_cast<std::size_t>(f)][present[k]] = 0;
    const std::uint64_t used =
        limits_.features < 64 ? (std::uint64_t{1} << limits_.features) - 1 : ~std::uint64_t{0};
    for (std::size_t i = leaf.begin; i != leaf.end; ++i)
      for (std::uint64_t left = samples_[i].features & used; left != 0; left &= left - 1)
        ++counts.ones[static_cast<std::size_t>(std::countr_zero(left))][samples_[i].symbol];

    const std::uint64_t samples = leaf.end - leaf.begin;
    std::uint64_t before = n_log_n(samples);
    for (std::size_t k = 0; k < symbols; ++k) before -= n_log_n(all[present[k]]);
    for (int f = 0; f < limits_.features; ++f) {
      const Histogram& ones = counts.ones[static_cast<std::size_t>(f)];
      std::uint64_t with = 0;
      std::uint64_t after = 0;
      std::int64_t symbols_of_both = 0;
      for (std::size_t k = 0; k < symbols; ++k) {
        const std::uint32_t one = ones[present[k]], zero = all[present[k]] - one;
        with += one;
        after += n_log_n(one) + n_log_n(zero);
        symbols_of_both += (one != 0) + (zero != 0);
      }
      if (with == 0 || with == samples) continue;
      after = n_log_n(with) + n_log_n(samples - with) - after;
      // Rounding of the logarithms may make a useless split look like a gain of part of a bit, or
      // like a loss.
      const std::int64_t saved =
          static_cast<std::int64_t>(before - after) * static_cast<std::int64_t>(limits_.weight);
      const std::int64_t gain =
          saved - kTableCost - kSymbolCost * (symbols_of_both - static_cast<std::int64_t>(symbols));
      if (gain > leaf.gain) {
        leaf.gain = gain;
        leaf.feature = f;
      }
    }
  }

  /// Places a node at `place_at` of the tree, and what is below it, depth first.
  void place(std::uint32_t growing, std::size_t place_at, ContextTree& tree) const {
    const GrowingNode& node = nodes_[growing];
    if (node.feature < 0) {
      tree.nodes[place_at] = static_cast<std::uint32_t>(tree.tables()) << 8 | kLeafNode;
      tree.weights.emplace_back();
      return;
    }
    const std::size_t children = tree.nodes.size();
    tree.nodes[place_at] =
        static_cast<std::uint32_t>(children) << 8 | static_cast<std::uint32_t>(node.feature);
    tree.nodes.resize(children + 2);
    place(node.children[0], children, tree);
    place(node.children[1], children + 1, tree);
  }

  std::span<ContextSample> samples_;
  const TreeLimits& limits_;
  Work work_;
  std::vector<GrowingNode> nodes_;
  std::unique_ptr<Counts> counts_[2];
};

}  // namespace

ContextTree train_tree(std::span<ContextSample> samples, const TreeLimits& limits, Work work) {
  return TreeGrower(samples, limits, work).grow();
}

}  // namespace voxdag
