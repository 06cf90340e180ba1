#include "voxdag/stored/attributes/join_page.hpp"

#include <algorithm>
#include <vector>

#include "voxdag/stored/attributes/fit_block.hpp"

namespace voxdag {
namespace {

/// The blocks of a page.
class PageJoiner {
 public:
  explicit PageJoiner(PagePrecision precision) : precision_(precision) {}

  /// Appends `count` values from number `first` on.
  void copy(const ValuePagesView& from, std::uint64_t first, int count) {
    const int index = static_cast<int>(first % kPageValues);
    const int here = std::min(count, kPageValues - index);
    copy_of_page(from, first / kPageValues, index, index + here);
    if (here < count) copy_of_page(from, first / kPageValues + 1, 0, count - here);
  }

  /// Repeats the last value up to the end of the page.
  void fill_up() {
    const int more = kPageValues - values_;
    if (more == 0) return;
    Block last = blocks_.back();
    std::fill_n(items_.begin() + values_, more, items_[static_cast<std::size_t>(values_ - 1)]);
    last.block.length = more;
    append(last);
  }

  /// Returns the page without errors.
  EncodedPage finish() {
    int bits = 0;
    for (const Block& block : blocks_) bits += precision_.bits_of(block.block);
    EncodedPage page;
    if (bits > 64 * kMaxPageWords) {
      store_each();
      page.rounds_copies = precision_.channel_bits(0) < 8;
    }
    const auto add = [&](std::uint64_t value, int width) {
      write_bits(page.words.data(), static_cast<std::uint64_t>(page.bits), width, value);
      page.bits += width;
    };
    const std::uint32_t* item = items_.data();
    for (const Block& of : blocks_) {
      const ValueBlock& block = of.block;
      add(precision_.pack_header(block), precision_.header_bits());
      if (block.type != ValueBlock::kRaw) add(of.e0, precision_.bits());
      if (block.is_line())
        add(of.second, block.has_step() ? ValueBlock::kStepBits : precision_.bits());
      for (int i = 0; i < block.length; ++i, ++item)
        if (block.type != ValueBlock::kFlat) add(*item, item_bits(block));
    }
    return page;
  }

 private:
  /// The numbers of its values, ends or weights, are in items_.
  struct Block {
    ValueBlock block;
    std::uint32_t e0 = 0, second = 0;
  };

  int item_bits(const ValueBlock& block) const {
    return block.type == ValueBlock::kRaw ? precision_.bits() : block.weight_bits();
  }

  /// Appends a block whose items follow those of the last one.
  void append(const Block& next) {
    values_ += next.block.length;
    const bool is_raw = next.block.type == ValueBlock::kRaw;
    if (!blocks_.empty()) {
      Block& last = blocks_.back();
      if (last.block.type == next.block.type &&
          (is_raw || (last.e0 == next.e0 && last.second == next.second))) {
        last.block.length += next.block.length;
        return;
      }
    }
    blocks_.push_back(next);
  }

  /// Appends the values `begin` to `end` - 1 of a page.
  void copy_of_page(const ValuePagesView& from, std::uint64_t page, int begin, int end) {
    std::uint64_t at = from.page_begin(page);
    const auto take = [&](int width) {
      const std::uint64_t value = read_bits(from.words, at, width);
      at += static_cast<std::uint64_t>(width);
      return static_cast<std::uint32_t>(value);
    };
    const int end_bits = from.precision.bits();
    const bool is_same = end_bits == precision_.bits();
    const auto end_of = [&](std::uint32_t stored) {
      return is_same ? stored : pack_end(from.precision.unpack(stored), precision_);
    };
    for (int first = 0; first < end;) {
      const ValueBlock block = from.precision.unpack_header(take(from.precision.header_bits()));
      const std::uint64_t body = at;
      const int lo = std::max(first, begin) - first,
                hi = std::min(first + block.length, end) - first;
      if (lo < hi) {
        const bool is_raw = block.type == ValueBlock::kRaw;
        Block part{{block.type, hi - lo}};
        if (!is_raw) part.e0 = end_of(take(end_bits));
        if (block.has_step())
          part.second = take(ValueBlock::kStepBits);
        else if (block.is_line())
          part.second = end_of(take(end_bits));
        const int width = is_raw ? end_bits : block.weight_bits();
        at += static_cast<std::uint64_t>(lo * width);
        for (int i = 0; i < hi - lo; ++i) {
          const std::uint32_t item = width == 0 ? 0 : take(width);
          items_[static_cast<std::size_t>(values_ + i)] = is_raw ? end_of(item) : item;
        }
        append(part);
      }
      at = body + static_cast<std::uint64_t>(block.body_bits(end_bits));
      first += block.length;
    }
  }

  /// Makes one block of all values.
  void store_each() {
    std::size_t i = 0;
    for (const Block& of : blocks_) {
      const ValueBlock& block = of.block;
      const Value8 e0 = precision_.unpack(of.e0);
      const Value8 e1 = block.has_step() ? stepped_end(e0, static_cast<int>(of.second))
                                         : precision_.unpack(of.second);
      const int most = (1 << block.weight_bits()) - 1;
      for (const std::size_t end = i + static_cast<std::size_t>(block.length); i < end; ++i) {
        if (block.type == ValueBlock::kRaw) continue;
        const int weight = static_cast<int>(items_[i]);
        items_[i] = block.is_line() ? pack_end(mix_ends(e0, e1, weight, most), precision_) : of.e0;
      }
    }
    blocks_ = {{{ValueBlock::kRaw, kPageValues}}};
  }

  PagePrecision precision_;
  std::vector<Block> blocks_;
  std::array<std::uint32_t, kPageValues> items_{};
  int values_ = 0;
};

}  // namespace

PagePrecision joined_precision(std::span<const PagePrecision> from) {
  const int code = from.empty() ? 3 : from[0].code & 3;
  const bool is_one = std::all_of(from.begin(), from.end(),
                                  [&](PagePrecision of) { return (of.code & 3) == code; });
  return {PagePrecision::kAnyLength + (is_one ? code : 3)};
}

EncodedPage join_page(std::span<const Value8> values, std::span<const CopiedValues> copies,
                      int given, const ValueMetric& metric, PagePrecision precision) {
  PageJoiner joiner(precision);
  ValueErrors errors;
  const auto add_new = [&](int begin, int end) {
    if (begin == end) return;
    std::array<Value8, kPageValues> rounded;
    for (int i = begin; i < end; ++i) {
      const Value8 value = values[static_cast<std::size_t>(i)];
      Value8& to = rounded[static_cast<std::size_t>(i - begin)];
      to = precision.unpack(pack_end(value, precision));
      errors.count(value, to);
    }
    std::fill(rounded.begin() + (end - begin), rounded.end(),
              rounded[static_cast<std::size_t>(end - begin - 1)]);
    const EncodedPage page = encode_page(rounded, metric, precision);
    constexpr std::uint64_t kGroup = 0;
    constexpr std::uint16_t kPage = 0;
    const ValuePagesView view{{&kGroup, &kPage, page.words.data(), page.words.size(), kPageValues},
                              precision};
    joiner.copy(view, 0, end - begin);
  };
  int at = 0;
  for (const CopiedValues& copied : copies) {
    add_new(at, copied.begin);
    joiner.copy(copied.from, copied.first, copied.count);
    at = copied.begin + copied.count;
  }
  add_new(at, given);
  joiner.fill_up();
  EncodedPage page = joiner.finish();
  page.errors = errors;
  return page;
}

}  // namespace voxdag
