#pragma once
/// A stream of bits in 32-bit words. Bit i of the stream is bit 31 - i % 32 of word i / 32, so that
/// the first bit of a number is its highest. The words end with a zero word beyond the last bit, so
/// that a reader may load two words at any bit.
#include <cstdint>
#include <utility>
#include <vector>

#include "voxdag/core/host_device.hpp"

namespace voxdag {

/// Returns the number of words of a stream of `bits` bits, with the zero word at its end.
VOXDAG_HD constexpr std::uint64_t stream_words(std::uint64_t bits) { return bits / 32 + 2; }

/// Returns `count` bits, 0 to 32, of the stream from bit `at` on, as a number.
VOXDAG_HD inline std::uint32_t read_bits(const std::uint32_t* words, std::uint64_t at, int count) {
  const std::uint32_t* word = words + (at >> 5);
  const std::uint64_t two = static_cast<std::uint64_t>(word[0]) << 32 | word[1];
  return static_cast<std::uint32_t>(two << (at & 31) >> 32 >> (32 - count));
}

/// Appends bits to a stream.
class BitWriter {
 public:
  /// Appends the lowest `count` bits of `value`, 0 to 32. All higher bits must be zero.
  void put(std::uint32_t value, int count) {
    pending_ = pending_ << count | value;
    const int held = static_cast<int>(bits_ & 31) + count;
    bits_ += static_cast<unsigned>(count);
    if (held >= 32) words_.push_back(static_cast<std::uint32_t>(pending_ >> (held - 32)));
  }
  /// Appends the lowest `count` bits of `value`, 0 to 64. All higher bits must be zero.
  void put_long(std::uint64_t value, int count) {
    if (count > 32) put(static_cast<std::uint32_t>(value >> 32), count - 32);
    put(static_cast<std::uint32_t>(value), count > 32 ? 32 : count);
  }
  /// Appends `count` bits of another stream, from its bit `at` on.
  void copy(const std::uint32_t* words, std::uint64_t at, std::uint64_t count) {
    for (; count > 32; at += 32, count -= 32) put(read_bits(words, at, 32), 32);
    put(read_bits(words, at, static_cast<int>(count)), static_cast<int>(count));
  }

  void reserve(std::uint64_t bits) { words_.reserve(stream_words(bits)); }
  std::uint64_t bits() const { return bits_; }

  /// Returns the words and empties the writer.
  std::vector<std::uint32_t> finish() {
    const int held = static_cast<int>(bits_ & 31);
    words_.push_back(static_cast<std::uint32_t>(pending_ << (32 - held)));
    words_.push_back(0);
    pending_ = bits_ = 0;
    return std::move(words_);
  }

 private:
  std::vector<std::uint32_t> words_;
  std::uint64_t pending_ = 0;  ///< The lowest (bits_ % 32) bits are not in a word yet.
  std::uint64_t bits_ = 0;
};

}  // namespace voxdag
