#pragma once
/// The contexts in which the wire form codes the blocks of value pages.
///
/// The same code encodes and decodes, so that both agree. docs/format.md lists the contexts.
#include <algorithm>
#include <cstdint>
#include <utility>

#include "voxdag/stored/attributes/value_pages.hpp"
#include "voxdag/stored/wire/range_coder.hpp"

namespace voxdag::wire {

/// Colours or normals: the last channel of a normal's end is predicted from the other two.
enum class ValueKind { kColor, kNormal };

/// The numbers of contexts of a ValueModel.
struct ValueModelSizes {
  static constexpr int kTypes = 8;
  static constexpr int kLengthBits = 8, kLengthContexts = 4;
  static constexpr int kEndBits = 8, kEndContexts = 12;
  static constexpr int kStepBits = ValueBlock::kStepBits;
  static constexpr int kWeightBits = 4;
  static constexpr int kNoWeight = 1 << kWeightBits;  ///< In place of a weight before the first.
};

/// The adaptive contexts, and the fields that choose among them. About 250 KB.
class ValueModel : private ValueModelSizes {
 public:
  explicit ValueModel(PagePrecision precision, ValueKind kind)
      : precision_(precision), kind_(kind) {}

  /// Codes the next page. `coder` is a RangeEncoder or a RangeDecoder. `bits` reads the page
  /// (take(width) returns the next bits, put() does nothing) or writes it (take() returns 0,
  /// put(width, value) appends; has_room(width) says whether so many bits may follow). Returns
  /// false where the coded bits are none of a page with room.
  template <class Coder, class Bits>
  bool code_page(Coder& coder, Bits& bits) {
    int values = 0;
    while (values < kPageValues) {
      if (!bits.has_room(precision_.header_bits())) return false;
      const ValueBlock block = code_header(coder, bits, values == 0);
      values += block.length;
      if (values > kPageValues || !bits.has_room(block.body_bits(precision_.bits()))) return false;
      code_ends(coder, bits, block);
      code_weights(coder, bits, block);
    }
    return true;
  }

 private:
  template <class Coder, class Bits>
  ValueBlock code_header(Coder& coder, Bits& bits, bool is_first) {
    const int header_bits = precision_.header_bits();
    const auto header = static_cast<std::uint32_t>(bits.take(header_bits));
    const std::uint32_t type = types_[last_type_][type_before_].code(coder, header & 7);
    const int of_length = is_first ? 0 : std::min(kLengthContexts - 1, 1 + last_length_ / 32);
    const std::uint32_t length =
        lengths_[type][of_length].code(coder, header >> 3, precision_.length_bits());
    bits.put(header_bits, length << 3 | type);
    const ValueBlock block = precision_.unpack_header(length << 3 | type);
    type_before_ = last_type_;
    last_type_ = block.type;
    last_length_ = block.length - 1;
    return block;
  }

  template <class Coder, class Bits>
  void code_ends(Coder& coder, Bits& bits, const ValueBlock& block) {
    const int ends = block.type == ValueBlock::kRaw ? block.length : 1;
    for (int i = 0; i < ends; ++i) code_end(coder, bits, 0, last_end_);
    if (block.has_step()) {
      const auto step = static_cast<std::uint32_t>(bits.take(kStepBits));
      bits.put(kStepBits, steps_[block.type].code(coder, step));
    } else if (block.is_line()) {
      Vec3i first_end = last_end_;
      code_end(coder, bits, 1, first_end);
    }
  }

  /// Codes an end, given one like it. Sets `like` to it.
  template <class Coder, class Bits>
  void code_end(Coder& coder, Bits& bits, int which, Vec3i& like) {
    const std::uint64_t given = bits.take(precision_.bits());
    const bool is_wide = last_type_ >= ValueBlock::kRaw;
    std::uint64_t end = 0;
    Vec3i fields;
    int context = 0;
    for (const int channel : {1, 0, 2}) {
      const int width = precision_.channel_bits(channel), size = 1 << width;
      int expected = like[channel];
      if (channel == 2 && kind_ == ValueKind::kNormal) expected = expect_z(fields, like.z, context);
      const int begin = begin_of(channel);
      const int field = static_cast<int>(given >> begin) & (size - 1);
      const auto difference = static_cast<std::uint32_t>(field - expected) & (size - 1u);
      const std::uint32_t coded =
          ends_[which][channel][context][is_wide].code(coder, difference, width);
      fields[channel] = (expected + static_cast<int>(coded)) & (size - 1);
      end |= static_cast<std::uint64_t>(fields[channel]) << begin;
      const int distance = static_cast<int>(coded) < size / 2 ? static_cast<int>(coded)
                                                              : size - static_cast<int>(coded);
      context = context_of(distance);
    }
    bits.put(precision_.bits(), end);
    like = fields;
  }

  int begin_of(int channel) const {
    int begin = 0;
    for (int c = 0; c < channel; ++c) begin += precision_.channel_bits(c);
    return begin;
  }

  static int context_of(int distance) {
    int context = 0;
    for (int limit = 1; limit <= 32 && distance >= limit; limit *= 2) ++context;
    return context;
  }

  /// Returns the z of a normal of unit length with these x and y, on the side of `like_z`. Sets the
  /// context of its field.
  int expect_z(Vec3i fields, int like_z, int& context) const {
    constexpr int kUnit = 512;
    const auto middle = [&](int channel) {
      return ((2 * fields[channel] + 1) << (9 - precision_.channel_bits(channel))) - kUnit;
    };
    const int x = middle(0), y = middle(1), left = kUnit * kUnit - x * x - y * y;
    int z = 0;
    for (int bit = kUnit; bit > 0; bit /= 2)
      if ((z + bit) * (z + bit) <= left) z += bit;
    context = left <= 0 ? 11 : z >= 384 ? 7 : z >= 256 ? 8 : z >= 128 ? 9 : 10;
    const int half = 1 << (precision_.channel_bits(2) - 1);
    const int height = z * half / kUnit;
    return like_z >= half ? std::min(half + height, 2 * half - 1) : std::max(half - 1 - height, 0);
  }

  template <class Coder, class Bits>
  void code_weights(Coder& coder, Bits& bits, const ValueBlock& block) {
    const int width = block.weight_bits();
    if (width == 0) return;
    std::uint32_t last = kNoWeight, before = kNoWeight;
    for (int i = 0; i < block.length; ++i) {
      const auto weight = static_cast<std::uint32_t>(bits.take(width));
      before = std::exchange(last, weights_[width - 1][last][before].code(coder, weight, width));
      bits.put(width, last);
    }
  }

  PagePrecision precision_;
  ValueKind kind_;
  int last_type_ = 0, type_before_ = 0, last_length_ = 0;
  Vec3i last_end_{};
  BitTree<3> types_[kTypes][kTypes];
  BitTree<kLengthBits> lengths_[kTypes][kLengthContexts];
  BitTree<kEndBits> ends_[2][3][kEndContexts][2];
  BitTree<kStepBits> steps_[kTypes];
  BitTree<kWeightBits> weights_[kWeightBits][kNoWeight + 1][kNoWeight + 1];
};

}  // namespace voxdag::wire
