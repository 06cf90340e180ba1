#include "voxdag/layout/compact/context_tree.hpp"

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

void ContextTree::prepare() {
  table_begin.clear();
  entries.clear();
  buckets.assign(tables() << kBucketBits, 0);
  for (std::size_t t = 0; t < tables(); ++t) {
    const auto first = static_cast<std::uint32_t>(entries.size());
    table_begin.push_back(first);
    const Frequencies frequencies = frequencies_of(weights[t]);
    std::vector<std::uint32_t> symbols;
    for (std::uint32_t s = 0; s < 256; ++s)
      if (frequencies[s] != 0) symbols.push_back(s);
    std::stable_sort(symbols.begin(), symbols.end(), [&](std::uint32_t a, std::uint32_t b) {
      return frequencies[a] > frequencies[b];
    });
    std::uint32_t start = 0;
    for (const std::uint32_t s : symbols) {
      const std::uint32_t frequency = frequencies[s];
      const auto entry = static_cast<std::uint32_t>(entries.size()) - first;
      entries.push_back(s | start << 8 | (frequency - 1) << 20);
      constexpr std::uint32_t kWidth = kSum >> kBucketBits;
      for (std::uint32_t b = (start + kWidth - 1) / kWidth; b * kWidth < start + frequency; ++b)
        buckets[t << kBucketBits | b] = static_cast<std::uint8_t>(entry);
      start += frequency;
    }
    // A table that is not used still ends a search.
    if (symbols.empty()) entries.push_back((kSum - 1) << 20);
  }
}

}  // namespace voxdag
