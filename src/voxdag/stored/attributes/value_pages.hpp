#pragma once
/// Compressed colours or normals of cells: values of three channels of 8 bits, by number.
///
/// A page holds 256 values with consecutive numbers, as a sequence of blocks. A block of n values:
///
///   header    type in bits 0..2, then n / 4 - 1 in 6 bits, or n - 1 in 8 bits (precision 4 to 7)
///   ends      depend on the type
///   weights   n weights of w bits
///
///   type      0      1, 2, 3             4             5, 6, 7
///   ends      e0     e0, step (6 bits)   n ends        e0, e1
///   w         0      1, 2, 3             0             2, 3, 4
///
/// An end is a value in the precision of the pages: each channel has 5 to 8 bits, and the first
/// channel is in the lowest bits. Repeating the highest bits of a channel makes it 8 bits wide. In
/// types 1 to 3, each channel of e1 is that of e0 plus 4 (step + 1), at most 255. In type 0 all
/// values are e0; in type 4 each value is an end. In other types, a value of weight k is
/// ((q - k) e0 + k e1) / q with q = 2^w - 1, rounded to the nearest integer, halves up.
///
/// Copies of the last value fill the last page up. cell_pages.hpp describes the tables that find
/// pages.
#include <cstdint>

#include "voxdag/core/vec.hpp"
#include "voxdag/stored/attributes/cell_pages.hpp"

namespace voxdag {

/// Lengths of blocks are multiples of this in the precisions 0 to 3.
inline constexpr int kBlockUnit = 4;

/// A value: a colour (red, green, blue, sRGB encoded) or a normal (see stored_attributes.hpp).
using Value8 = Vec3<std::uint8_t>;

/// The header of a block, and the sizes of the block's parts.
struct ValueBlock {
  enum Type : int { kFlat = 0, kRaw = 4 };
  static constexpr int kTypeBits = 3, kStepBits = 6, kStepUnit = 4;

  int type = kFlat;
  int length = kBlockUnit;  ///< Number of values.

  VOXDAG_HD constexpr bool is_line() const { return type != kFlat && type != kRaw; }
  VOXDAG_HD constexpr bool has_step() const { return type >= 1 && type <= 3; }
  /// Returns w.
  VOXDAG_HD constexpr int weight_bits() const {
    return !is_line() ? 0 : type < 4 ? type : type - 3;
  }
  /// Returns the number of bits of the ends and the step. An end has `end_bits` bits.
  VOXDAG_HD constexpr int ends_bits(int end_bits) const {
    return type == kFlat  ? end_bits
           : type == kRaw ? length * end_bits
           : has_step()   ? end_bits + kStepBits
                          : 2 * end_bits;
  }
  /// Returns the number of bits after the header.
  VOXDAG_HD constexpr int body_bits(int end_bits) const {
    return ends_bits(end_bits) + weight_bits() * length;
  }
};

/// The numbers of bits of an end's channels and of a block's length.
struct PagePrecision {
  static constexpr int kMaxCode = 7;
  static constexpr int kAnyLength = 4;  ///< Added to a code: blocks may have any length.

  /// 0: 5, 6, 5; 1: 6, 6, 6; 2: 7, 7, 7; 3: 8, 8, 8; 4 to 7: the same, with blocks of any length.
  int code = 0;

  /// Returns what the lengths of blocks are multiples of.
  VOXDAG_HD constexpr int unit() const { return code < kAnyLength ? kBlockUnit : 1; }
  VOXDAG_HD constexpr int length_bits() const { return code < kAnyLength ? 6 : 8; }
  VOXDAG_HD constexpr int header_bits() const { return ValueBlock::kTypeBits + length_bits(); }
  /// Returns the block with this header, whose other bits are zero.
  VOXDAG_HD constexpr ValueBlock unpack_header(std::uint64_t header) const {
    return {static_cast<int>(header & 7),
            unit() * (static_cast<int>(header >> ValueBlock::kTypeBits) + 1)};
  }
  VOXDAG_HD constexpr std::uint64_t pack_header(const ValueBlock& block) const {
    return static_cast<std::uint64_t>((block.length / unit() - 1) << ValueBlock::kTypeBits |
                                      block.type);
  }
  /// Returns the number of bits of a whole block.
  VOXDAG_HD constexpr int bits_of(const ValueBlock& block) const {
    return header_bits() + block.body_bits(bits());
  }

  VOXDAG_HD constexpr int channel_bits(int channel) const {
    const int fine = code & 3;
    return fine > 0 ? fine + 5 : channel == 1 ? 6 : 5;
  }
  /// Returns the number of bits of an end.
  VOXDAG_HD constexpr int bits() const {
    const int fine = code & 3;
    return fine > 0 ? 3 * (fine + 5) : 16;
  }
  /// Returns the value that an end stands for.
  VOXDAG_HD constexpr Value8 unpack(std::uint64_t end) const {
    Value8 value{};
    for (int c = 0; c < 3; ++c) {
      const int bits = channel_bits(c);
      const auto field = static_cast<std::uint32_t>(end) & ((1u << bits) - 1u);
      end >>= bits;
      value[c] = static_cast<std::uint8_t>(field << (8 - bits) | field >> (2 * bits - 8));
    }
    return value;
  }
};

/// Returns the value of weight `k`, 0 to `most`, between two ends.
VOXDAG_HD constexpr Value8 mix_ends(Value8 e0, Value8 e1, int k, int most) {
  Value8 value{};
  for (int c = 0; c < 3; ++c)
    value[c] =
        static_cast<std::uint8_t>((2 * (e0[c] * (most - k) + e1[c] * k) + most) / (2 * most));
  return value;
}

/// Returns the second end of types 1 to 3.
VOXDAG_HD constexpr Value8 stepped_end(Value8 e0, int step) {
  Value8 end{};
  for (int c = 0; c < 3; ++c) {
    const int sum = e0[c] + ValueBlock::kStepUnit * (step + 1);
    end[c] = static_cast<std::uint8_t>(sum < 255 ? sum : 255);
  }
  return end;
}

/// A view for kernels and readers.
struct ValuePagesView : CellPagesView {
  PagePrecision precision;
};

/// Values in memory. The view is valid while this object lives unchanged.
struct ValuePages : CellPages {
  PagePrecision precision;

  ValuePagesView view() const { return {CellPages::view(), precision}; }
};

/// Returns the value with number `number`, less than view.values. Skips half of the page's blocks
/// on average.
VOXDAG_HD inline Value8 read_value(const ValuePagesView& view, std::uint64_t number) {
  std::uint64_t at = view.page_begin(number / kPageValues);
  int index = static_cast<int>(number % kPageValues);
  const int end_bits = view.precision.bits(), header_bits = view.precision.header_bits();
  ValueBlock block = view.precision.unpack_header(read_bits(view.words, at, header_bits));
  while (index >= block.length) {
    index -= block.length;
    at += static_cast<std::uint64_t>(header_bits + block.body_bits(end_bits));
    block = view.precision.unpack_header(read_bits(view.words, at, header_bits));
  }
  at += static_cast<std::uint64_t>(header_bits);
  if (block.type == ValueBlock::kRaw) at += static_cast<std::uint64_t>(index * end_bits);
  const Value8 e0 = view.precision.unpack(read_bits(view.words, at, end_bits));
  if (!block.is_line()) return e0;
  at += static_cast<std::uint64_t>(end_bits);
  Value8 e1{};
  if (block.has_step()) {
    e1 = stepped_end(e0, static_cast<int>(read_bits(view.words, at, ValueBlock::kStepBits)));
    at += ValueBlock::kStepBits;
  } else {
    e1 = view.precision.unpack(read_bits(view.words, at, end_bits));
    at += static_cast<std::uint64_t>(end_bits);
  }
  const int w = block.weight_bits();
  at += static_cast<std::uint64_t>(index * w);
  return mix_ends(e0, e1, static_cast<int>(read_bits(view.words, at, w)), (1 << w) - 1);
}

}  // namespace voxdag
