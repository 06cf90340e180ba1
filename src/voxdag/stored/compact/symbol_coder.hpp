#pragma once
/// The entropy coder of the compact form: arithmetic coding with fixed frequencies.
///
/// Source: G. N. N. Martin, "Range encoding: an algorithm for removing redundancy from a digitised
/// message", 1979; renormalised by single bits as in I. Witten, R. Neal and J. Cleary, "Arithmetic
/// coding for data compression", CACM 1987.
///
/// A record is a sequence of symbols. Each symbol has an interval [start, start + frequency) of
/// [0, 4096). A record's bits are a number in [0, 1), which each symbol narrows to a part of the
/// interval so far. The reader keeps the width of that interval, `range`, and the distance of the
/// number from its lower end, `code`, both scaled so that 2^30 < range <= 2^31. With r = range /
/// 4096, rounded down, the symbol is the one with start * r <= code < (start + frequency) * r. Then
///   code = code - start * r,  range = frequency * r
/// and both are doubled, with the next bits of the stream in code, until range > 2^30.
///
/// There are two kinds of records. The reader of a *closed* record knows where its bits end, and
/// continues with zeros there: the writer chooses the number with the fewest bits. The reader of an
/// *open* record does not know its end: the writer adds two bits, with which any bits may follow.
#include <cstdint>
#include <vector>

#include "voxdag/core/bits.hpp"
#include "voxdag/stored/compact/bit_stream.hpp"

namespace voxdag {

inline constexpr int kFrequencyBits = 12;  ///< The frequencies of a table add up to 2^12.
inline constexpr int kRangeBits = 31;      ///< 2^30 < range <= 2^31.
inline constexpr int kOpenBits = 2;        ///< Bits of an open record beyond its doublings.
inline constexpr int kMaxRawBits = 12;     ///< The largest number of bits of one raw number.

/// Returns how often a range from 1 to 2^31 is doubled until it is above 2^30.
VOXDAG_HD inline int doublings(std::uint32_t range) {
  return range == 1 ? kRangeBits : kRangeBits - 1 - highest_bit(range - 1);
}

/// Reads the symbols of one record.
class SymbolReader {
 public:
  /// Starts at bit `begin`. `end` is the end of a closed record, or any bit at or after the end of
  /// an open one.
  VOXDAG_HD SymbolReader(const std::uint32_t* words, std::uint64_t begin, std::uint64_t end)
      : words_(words), at_(begin), end_(end) {
    code_ = next(kRangeBits);
  }

  /// Returns the width of a 4096th of the interval.
  VOXDAG_HD std::uint32_t unit() const { return range_ >> kFrequencyBits; }
  /// Returns the distance of the number from the lower end of the interval.
  VOXDAG_HD std::uint32_t code() const { return code_; }

  /// Removes the symbol with the interval [start, start + frequency).
  VOXDAG_HD void take(std::uint32_t start, std::uint32_t frequency) {
    const std::uint32_t r = unit();
    narrow(start * r, frequency * r);
  }

  /// Removes and returns a number of `bits` bits, 0 to 32, that was written with put_raw().
  VOXDAG_HD std::uint32_t take_raw(int bits) {
    std::uint32_t value = 0;
    for (int left = bits; left > 0;) {
      const int count = left < kMaxRawBits ? left : kMaxRawBits;
      const std::uint32_t r = range_ >> count, most = (1u << count) - 1;
      const std::uint32_t part = code_ / r < most ? code_ / r : most;
      narrow(part * r, r);
      value = value << count | part;
      left -= count;
    }
    return value;
  }

  /// Returns the bit after an open record. All its symbols must have been read.
  VOXDAG_HD std::uint64_t open_end() const { return at_ - kRangeBits + kOpenBits; }
  /// Returns whether a closed record has no more bits than its symbols can take. All of them must
  /// have been read.
  VOXDAG_HD bool is_finished() const { return end_ <= open_end(); }

 private:
  VOXDAG_HD void narrow(std::uint32_t below, std::uint32_t range) {
    const int count = doublings(range);
    range_ = range << count;
    code_ = (code_ - below) << count | next(count);
  }
  /// Returns the next `count` bits, 0 to 31; zeros behind the end.
  VOXDAG_HD std::uint32_t next(int count) {
    const std::uint64_t at = at_;
    at_ += static_cast<unsigned>(count);
    if (at_ <= end_) return read_bits(words_, at, count);
    if (at >= end_) return 0;
    const auto left = static_cast<int>(end_ - at);
    return read_bits(words_, at, left) << (count - left);
  }

  const std::uint32_t* words_;
  std::uint64_t at_, end_;
  std::uint32_t code_ = 0, range_ = 1u << kRangeBits;
};

/// Writes the symbols of one record after the other.
class SymbolWriter {
 public:
  /// Adds the symbol with the interval [start, start + frequency).
  void put(std::uint32_t start, std::uint32_t frequency) {
    const std::uint32_t r = range_ >> kFrequencyBits;
    narrow(start * r, frequency * r);
  }
  /// Adds a number of `bits` bits, 0 to 32. Each value takes as many bits as any other.
  void put_raw(std::uint32_t value, int bits) {
    for (int left = bits; left > 0;) {
      const int count = left < kMaxRawBits ? left : kMaxRawBits;
      left -= count;
      const std::uint32_t r = range_ >> count;
      narrow((value >> left & ((1u << count) - 1)) * r, r);
    }
  }

  /// Appends the record to `out` as a closed one, and starts the next record.
  void close(BitWriter& out) {
    int extra = 0;
    while (!add_bits_inside(extra)) ++extra;
    std::size_t ones = digits_.size();
    while (ones > 0 && digits_[ones - 1] == 0) --ones;
    std::uint64_t count = ones * kDigitBits;
    if (ones > 0) {
      const std::uint32_t last = digits_[ones - 1];
      count -= static_cast<unsigned>(lowest_bit64(last));
    }
    write(count, out);
  }
  /// Appends the record to `out` as an open one, and starts the next record.
  void leave_open(BitWriter& out) {
    const std::uint64_t count = doublings_ + kOpenBits;
    add_open_bits();
    write(count, out);
  }

 private:
  static constexpr int kDigitBits = 16;

  void narrow(std::uint32_t below, std::uint32_t range) {
    low_ += below;
    const int count = doublings(range);
    range_ = range << count;
    shift(count);
  }
  /// Doubles `low_` `count` times, and moves the bits above it to the digits.
  void shift(int count) {
    low_ <<= count;
    held_ += count;
    doublings_ += static_cast<unsigned>(count);
    while (held_ >= kDigitBits) {
      held_ -= kDigitBits;
      const int below = kRangeBits + held_;
      push_digit(static_cast<std::uint32_t>(low_ >> below));
      low_ &= (std::uint64_t{1} << below) - 1;
    }
  }
  /// Appends a digit of 16 bits, and a carry above it to the digits before.
  void push_digit(std::uint32_t digit) {
    for (std::size_t i = digits_.size(); digit >> kDigitBits != 0 && i-- > 0;) {
      digits_[i] = (digits_[i] + 1) & 0xFFFFu;
      if (digits_[i] != 0) break;
    }
    digits_.push_back(digit & 0xFFFFu);
  }

  /// Looks for the least number in the interval that ends `extra` bits behind the doublings. If
  /// there is one, makes it the digits and returns true.
  bool add_bits_inside(int extra) {
    const std::uint64_t step = std::uint64_t{1} << (kRangeBits - extra);
    const std::uint64_t number = (low_ + step - 1) / step * step;
    if (number - low_ >= range_) return false;
    low_ = number;
    flush();
    return true;
  }
  /// Makes the least multiple of 2^29 in the interval the digits. It is at most 2^29 above `low_`,
  /// so the 2^29 numbers from it on are in the interval, too: its next 29 bits may be any.
  void add_open_bits() {
    const std::uint64_t step = std::uint64_t{1} << (kRangeBits - kOpenBits);
    low_ = (low_ + step - 1) / step * step;
    flush();
  }
  /// Moves all bits of `low_` to the digits.
  void flush() {
    for (int left = kRangeBits + held_; left > 0; left -= kDigitBits) {
      const int below = kRangeBits + held_ - kDigitBits;
      push_digit(static_cast<std::uint32_t>(below >= 0 ? low_ >> below : low_ << -below));
      low_ = below >= 0 ? low_ & ((std::uint64_t{1} << below) - 1) : 0;
      held_ -= kDigitBits;
    }
  }
  void write(std::uint64_t count, BitWriter& out) {
    std::uint64_t left = count;
    for (std::size_t i = 0; left > 0; ++i) {
      const int part = left < kDigitBits ? static_cast<int>(left) : kDigitBits;
      out.put(digits_[i] >> (kDigitBits - part), part);
      left -= static_cast<unsigned>(part);
    }
    digits_.clear();
    low_ = doublings_ = 0;
    held_ = 0;
    range_ = 1u << kRangeBits;
  }

  std::vector<std::uint32_t> digits_;  ///< The first bits of the number, 16 in each.
  std::uint64_t low_ = 0;  ///< The next bits: held_ of them, 31 bits, and a carry above.
  std::uint64_t doublings_ = 0;
  int held_ = 0;
  std::uint32_t range_ = 1u << kRangeBits;
};

}  // namespace voxdag
