#pragma once
/// Reads many compressed values with nearby numbers: each page is decoded once.
#include <array>
#include <limits>

#include "voxdag/stored/attributes/value_pages.hpp"

namespace voxdag {

/// Holds the page that it read last. Refers to the pages. Each thread needs its own.
class PageReader {
 public:
  explicit PageReader(const ValuePagesView& pages) : pages_(pages) {}

  /// Returns the value with number `number`, less than pages.values: that of read_value().
  Value8 value(std::uint64_t number) {
    if (number / kPageValues != page_) decode(number / kPageValues);
    return values_[number % kPageValues];
  }

 private:
  void decode(std::uint64_t page) {
    const int end_bits = pages_.precision.bits();
    std::uint64_t at = pages_.page_begin(page);
    const auto take = [&](int bits) {
      const std::uint64_t value = read_bits(pages_.words, at, bits);
      at += static_cast<std::uint64_t>(bits);
      return value;
    };
    for (std::size_t first = 0; first < kPageValues;) {
      const ValueBlock block = pages_.precision.unpack_header(take(pages_.precision.header_bits()));
      const std::size_t end = first + static_cast<std::size_t>(block.length);
      Value8 e0{}, e1{};
      if (block.type != ValueBlock::kRaw) e0 = pages_.precision.unpack(take(end_bits));
      if (block.has_step())
        e1 = stepped_end(e0, static_cast<int>(take(ValueBlock::kStepBits)));
      else if (block.is_line())
        e1 = pages_.precision.unpack(take(end_bits));
      const int width = block.weight_bits(), most = (1 << width) - 1;
      for (; first < end; ++first)
        values_[first] = block.type == ValueBlock::kRaw ? pages_.precision.unpack(take(end_bits))
                         : block.is_line() ? mix_ends(e0, e1, static_cast<int>(take(width)), most)
                                           : e0;
    }
    page_ = page;
  }

  const ValuePagesView pages_;
  std::uint64_t page_ = std::numeric_limits<std::uint64_t>::max();
  std::array<Value8, kPageValues> values_;
};

}  // namespace voxdag
