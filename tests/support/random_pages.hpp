#pragma once
/// Pages of values with blocks of every type.
#include <algorithm>
#include <cstdint>
#include <random>

#include "voxdag/stored/attributes/value_pages.hpp"

namespace voxdag {

/// Returns pages of random blocks of every type. `busy`, 0 to 1, says how often ends and weights
/// change.
inline ValuePages random_pages(std::uint64_t values, int precision, unsigned seed, double busy) {
  ValuePages pages;
  pages.values = values;
  pages.precision = {precision};
  std::mt19937_64 rng(seed);
  std::uint64_t at = 0, end = 0, weights = 0;
  const auto add = [&](int width, std::uint64_t value) {
    pages.words.resize((at + static_cast<std::uint64_t>(width) + 63) / 64);
    write_bits(pages.words.data(), at, width, value & ((std::uint64_t{1} << width) - 1));
    at += static_cast<std::uint64_t>(width);
  };
  const auto change = [&](std::uint64_t& bits) {
    if (std::bernoulli_distribution(busy)(rng)) bits = rng();
    return bits;
  };
  for (std::uint64_t page = 0; page < pages.view().page_count(); ++page) {
    at = (at + 7) / 8 * 8;
    pages.add_page(at / 8);
    for (int left = kPageValues; left > 0;) {
      ValueBlock block{static_cast<int>(rng() % 8), 0};
      block.length = std::min(left, pages.precision.unit() * (1 + static_cast<int>(rng() % 9)));
      if (rng() % 20 == 0) block.length = left;
      left -= block.length;
      add(pages.precision.header_bits(), pages.precision.pack_header(block));
      const int width = pages.precision.bits();
      for (int i = 0; i < (block.type == ValueBlock::kRaw ? block.length : 1); ++i)
        add(width, change(end));
      if (block.has_step())
        add(ValueBlock::kStepBits, rng());
      else if (block.is_line())
        add(width, change(end));
      for (int i = 0; i < block.length; ++i) add(block.weight_bits(), change(weights));
    }
  }
  return pages;
}

}  // namespace voxdag
