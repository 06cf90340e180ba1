#include "voxdag/stored/compact/context_tree.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

namespace voxdag {
namespace {

constexpr std::uint32_t kSum = 1u << kFrequencyBits;

std::uint32_t weight_of_code(std::uint8_t code) {
  if (code <= 4) return code;
  return (4u + ((code - 1u) & 3u)) << ((code - 1u) / 4u - 1u);
}

/// Returns the code of the largest weight that is at most `weight`, from 1 to 4096.
std::uint8_t code_of_weight(std::uint32_t weight) {
  if (weight <= 4) return static_cast<std::uint8_t>(weight);
  const auto shift = static_cast<unsigned>(std::bit_width(weight)) - 3;
  return static_cast<std::uint8_t>(1 + 4 * (shift + 1) + (weight >> shift & 3u));
}

}  // namespace

Frequencies frequencies_of(const WeightCodes& weights) {
  std::uint64_t total = 0, used = 0;
  for (const std::uint8_t code : weights) {
    total += weight_of_code(code);
    used += code != 0;
  }
  Frequencies frequencies{};
  if (total == 0) return frequencies;
  std::uint64_t left = kSum;
  std::size_t most = 0;
  for (std::size_t s = 0; s < 256; ++s) {
    if (weights[s] == 0) continue;
    const std::uint64_t share = weight_of_code(weights[s]) * (kSum - used) / total;
    frequencies[s] = static_cast<std::uint16_t>(1 + share);
    left -= frequencies[s];
    if (frequencies[s] > frequencies[most]) most = s;
  }
  frequencies[most] = static_cast<std::uint16_t>(frequencies[most] + left);
  return frequencies;
}

WeightCodes weights_for(const std::array<std::uint32_t, 256>& counts) {
  const std::uint64_t total = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0});
  WeightCodes weights{};
  for (std::size_t s = 0; s < 256; ++s) {
    if (counts[s] == 0) continue;
    // Small counts stay as they are: small weights take fewer bytes.
    const std::uint64_t weight =
        total <= kSum ? counts[s] : (counts[s] * std::uint64_t{kSum} + total / 2) / total;
    weights[s] = code_of_weight(static_cast<std::uint32_t>(std::max<std::uint64_t>(weight, 1)));
  }
  return weights;
}

std::array<SymbolInterval, 256> intervals_of(const WeightCodes& weights) {
  const Frequencies frequencies = frequencies_of(weights);
  std::array<std::uint32_t, 256> order;
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return frequencies[a] > frequencies[b];
  });
  std::array<SymbolInterval, 256> intervals;
  std::uint32_t start = 0;
  for (const std::uint32_t s : order) {
    intervals[s] = {static_cast<std::uint16_t>(start), frequencies[s]};
    start += frequencies[s];
  }
  return intervals;
}

void ContextTree::prepare() {
  steps = nodes;
  starts.clear();
  for (std::uint32_t value = 0; value < 1u << kStartBits; ++value) {
    std::uint32_t at = 0;
    for (;;) {
      const int tested = static_cast<int>(nodes[at] & 63u) - kFirstStartFeature;
      if ((nodes[at] & kLeafNode) != 0 || tested < 0 || tested >= kStartBits) break;
      at = (nodes[at] >> 8) + (value >> tested & 1u);
    }
    starts.push_back(at);
  }

  entries.clear();
  std::vector<std::uint32_t> places;
  for (const WeightCodes& table_weights : weights) {
    const std::size_t place = entries.size();
    places.push_back(static_cast<std::uint32_t>(place));
    const std::array<SymbolInterval, 256> intervals = intervals_of(table_weights);
    std::vector<std::uint32_t> symbols;
    for (std::uint32_t s = 0; s < 256; ++s)
      if (intervals[s].frequency != 0) symbols.push_back(s);
    std::sort(symbols.begin(), symbols.end(), [&](std::uint32_t a, std::uint32_t b) {
      return intervals[a].start < intervals[b].start;
    });
    entries.push_back(static_cast<std::uint32_t>(symbols.size()));
    for (const std::uint32_t s : symbols)
      entries.push_back(s | std::uint32_t{intervals[s].start} << 8 |
                        (std::uint32_t{intervals[s].frequency} - 1) << 20);
    // A table that is not used reads as one that has the symbol 0 only.
    if (!symbols.empty()) continue;
    entries.back() = 1;
    entries.push_back((kSum - 1) << 20);
  }
  for (std::uint32_t& step : steps)
    if ((step & kLeafNode) != 0) step = places[step >> 8] << 8 | kLeafNode;
}

}  // namespace voxdag
