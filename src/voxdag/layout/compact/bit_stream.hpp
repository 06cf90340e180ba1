#pragma once
/// A stream of bits in 32-bit words. Bit i of the stream is bit i % 32 of word i / 32. The words
/// end with one zero word more than the bits need, so that a reader may load two words at any bit.
#include <cstdint>
#include <vector>

#include "voxdag/core/host_device.hpp"

namespace voxdag {

/// Returns the number of words of a stream of `bits` bits, with the zero word at its end.
VOXDAG_HD constexpr std::uint64_t stream_words(std::uint64_t bits) { return bits / 32 + 2; }

/// Returns `count` bits, 0 to 32, of the stream from bit `at` on; the first bit is the lowest.
VOXDAG_HD inline std::uint32_t read_bits(const std::uint32_t* words, std::uint64_t at, int count) {
  const std::uint32_t* word = words + (at >> 5);
  const std::uint64_t two = word[0] | static_cast<std::uint64_t>(word[1]) << 32;
  return static_cast<std::uint32_t>(two >> (at & 31) & ((std::uint64_t{1} << count) - 1));
}

/// Appends bits to a stream.
class BitWriter {
 public:
  /// Appends the lowest `count` bits of `value`, 0 to 32. All higher bits must be zero.
  void put(std::uint32_t value, int count) {
    pending_ |= static_cast<std::uint64_t>(value) << (bits_ & 31);
    const std::uint64_t before = bits_;
    bits_ += static_cast<unsigned>(count);
    if (before >> 5 == bits_ >> 5) return;
    words_.push_back(static_cast<std::uint32_t>(pending_));
    pending_ >>= 32;
  }
  /// Appends the lowest `count` bits of `value`, 0 to 64.
  void put_long(std::uint64_t value, int count) {
    if (count > 32) {
      put(static_cast<std::uint32_t>(value), 32);
      put(static_cast<std::uint32_t>(value >> 32), count - 32);
    } else {
      put(static_cast<std::uint32_t>(value), count);
    }
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
    words_.push_back(static_cast<std::uint32_t>(pending_));
    words_.push_back(0);
    pending_ = bits_ = 0;
    return std::move(words_);
  }

 private:
  std::vector<std::uint32_t> words_;
  std::uint64_t pending_ = 0;  ///< The bits of the word that is not complete.
  std::uint64_t bits_ = 0;
};

}  // namespace voxdag
