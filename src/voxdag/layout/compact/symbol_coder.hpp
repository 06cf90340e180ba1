#pragma once
/// The entropy coder of the compact form: asymmetric numeral systems with a state of 17 bits.
///
/// Source: J. Duda, "Asymmetric numeral systems: entropy coding combining speed of Huffman coding
/// with compression rate of arithmetic coding", 2013 (the range variant, rANS).
///
/// A record is a sequence of symbols. Each symbol has an interval [start, start + frequency) of
/// [0, 4096). The state x is a number whose leading bit marks its length. To push a symbol, the
/// writer moves low bits of x to the stream until x < 32 * frequency, then sets
///   x = x / frequency * 4096 + x % frequency + start.
/// The reader does the reverse: the low 12 bits of x select the symbol, then
///   x = x / 4096 * frequency + x % 4096 - start,
/// and bits of the stream extend x to 17 bits. The writer pushes the last symbol first.
///
/// A record ends in one of two ways. A *closed* record knows where its bits end: the writer starts
/// with x = 1, and the whole record is one number of that many bits, so that no bit is lost. An
/// *open* record does not know it: the writer starts with x = 2^16 + tail, and the reader finds the
/// 16 bits of `tail` in the state after the last symbol.
#include <cstdint>
#include <vector>

#include "voxdag/core/bits.hpp"
#include "voxdag/layout/compact/bit_stream.hpp"

namespace voxdag {

inline constexpr int kFrequencyBits = 12;  ///< The frequencies of a table add up to 2^12.
inline constexpr int kStateBits = 16;      ///< A full state x has 2^16 <= x < 2^17.
inline constexpr int kMostRawBits = 12;    ///< The largest number of bits of one raw symbol.

/// Reads the symbols of one record.
class SymbolReader {
 public:
  /// Starts at bit `at`. `end` is the end of a closed record, or any bit at or after the end of an
  /// open one.
  VOXDAG_HD SymbolReader(const std::uint32_t* words, std::uint64_t at, std::uint64_t end)
      : words_(words), at_(at), end_(end) {
    refill();
  }

  /// Returns the 12 bits that select the next symbol.
  VOXDAG_HD std::uint32_t slot() const { return x_ & ((1u << kFrequencyBits) - 1); }

  /// Removes the symbol with the interval [start, start + frequency), which holds slot().
  VOXDAG_HD void take(std::uint32_t start, std::uint32_t frequency) {
    x_ = (x_ >> kFrequencyBits) * frequency + slot() - start;
    refill();
  }

  /// Returns and removes a number of `bits` bits, all values of which are equally likely.
  VOXDAG_HD std::uint32_t take_raw(int bits) {
    std::uint32_t value = 0;
    for (int done = 0; done < bits; done += kMostRawBits) {
      const int count = bits - done < kMostRawBits ? bits - done : kMostRawBits;
      value |= (x_ & ((1u << count) - 1)) << done;
      x_ >>= count;
      refill();
    }
    return value;
  }

  /// Returns whether a closed record has ended as its writer began.
  VOXDAG_HD bool is_finished() const { return x_ == 1 && at_ == end_; }
  /// Returns the tail of an open record, after its last symbol.
  VOXDAG_HD std::uint32_t tail() const { return x_ & ((1u << kStateBits) - 1); }
  /// Returns the bit after the last one that was read.
  VOXDAG_HD std::uint64_t position() const { return at_; }
  VOXDAG_HD bool is_full() const { return x_ >> kStateBits == 1; }

 private:
  VOXDAG_HD void refill() {
    // A broken record may lead to x = 0. The lowest bit is set here so that highest_bit() is
    // defined.
    const int missing = kStateBits - highest_bit(x_ | 1u);
    const std::uint64_t left = end_ - at_;
    const int count = left < static_cast<std::uint64_t>(missing) ? static_cast<int>(left) : missing;
    x_ = x_ << count | read_bits(words_, at_, count);
    at_ += static_cast<std::uint64_t>(count);
  }

  const std::uint32_t* words_;
  std::uint64_t at_, end_;
  std::uint32_t x_ = 1;
};

/// Collects the symbols of one record in the order of reading, then writes them.
class SymbolWriter {
 public:
  void put(std::uint32_t start, std::uint32_t frequency) {
    symbols_.push_back(start | frequency << 16);
  }
  void put_raw(std::uint32_t value, int bits) {
    for (int done = 0; done < bits; done += kMostRawBits) {
      const int count = bits - done < kMostRawBits ? bits - done : kMostRawBits;
      put((value >> done & ((1u << count) - 1)) | kRaw, static_cast<std::uint32_t>(count));
    }
  }

  /// Appends the symbols to `out` as a closed record and forgets them.
  void close(BitWriter& out) { write(1, out); }
  /// Appends the symbols to `out` as an open record whose tail has 16 bits, and forgets them.
  void leave_open(std::uint32_t tail, BitWriter& out) { write(1u << kStateBits | tail, out); }

 private:
  /// Marks a raw number: its value is in place of `start`, its number of bits of `frequency`.
  static constexpr std::uint32_t kRaw = 1u << 15;

  void write(std::uint32_t x, BitWriter& out) {
    emitted_.clear();
    for (std::size_t i = symbols_.size(); i-- > 0;) {
      const bool is_raw = (symbols_[i] & kRaw) != 0;
      const std::uint32_t start = symbols_[i] & (kRaw - 1), size = symbols_[i] >> 16;
      const std::uint32_t frequency = is_raw ? 1u << (kFrequencyBits - size) : size;
      int count = 0;
      while (x >> count >= frequency << (kStateBits + 1 - kFrequencyBits)) ++count;
      if (count != 0)
        emitted_.push_back((x & ((1u << count) - 1)) << 8 | static_cast<unsigned>(count));
      x >>= count;
      x = is_raw ? x << size | start : (x / frequency << kFrequencyBits) + x % frequency + start;
    }
    const int head = highest_bit(x);
    out.put(x & ((1u << head) - 1), head);
    for (std::size_t i = emitted_.size(); i-- > 0;)
      out.put(emitted_[i] >> 8, static_cast<int>(emitted_[i] & 0xFFu));
    symbols_.clear();
  }

  std::vector<std::uint32_t> symbols_;  ///< start | frequency << 16.
  std::vector<std::uint32_t> emitted_;  ///< Bits that left the state: value << 8 | count.
};

}  // namespace voxdag
