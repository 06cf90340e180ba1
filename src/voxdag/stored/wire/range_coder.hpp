#pragma once
/// An adaptive binary range coder: bits take the fewer bytes, the better their context tells them.
///
/// Integers only, so that every machine writes and reads the same bytes. The coder is that of LZMA
/// (Pavlov 1998) with finer probabilities: the mean of one that learns fast and one that learns
/// slowly.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace voxdag::wire {

/// The probability that a bit is 1 in some context, in units of 2^-16, as two estimates.
struct AdaptiveBit {
  static constexpr int kFast = 4, kSlow = 7;  ///< Each bit moves an estimate by 2^-kFast, 2^-kSlow.

  std::uint16_t fast = 0x8000, slow = 0x8000;

  /// Returns the probability in units of 2^-15: 35 to 32732.
  std::uint32_t of_one() const { return (std::uint32_t{fast} + slow) >> 2; }
  void learn(bool bit) {
    if (bit) {
      fast = static_cast<std::uint16_t>(fast + ((0xFFFF - fast) >> kFast));
      slow = static_cast<std::uint16_t>(slow + ((0xFFFF - slow) >> kSlow));
    } else {
      fast = static_cast<std::uint16_t>(fast - (fast >> kFast));
      slow = static_cast<std::uint16_t>(slow - (slow >> kSlow));
    }
  }
};

/// The contexts of a number of `bits` bits: one for each of its bits, given those above it.
template <int bits>
struct BitTree {
  AdaptiveBit contexts[1 << bits];

  /// Codes the lowest `width` bits of `value`, the highest first. Returns them.
  template <class Coder>
  std::uint32_t code(Coder& coder, std::uint32_t value, int width = bits) {
    std::uint32_t prefix = 1;
    for (int bit = width - 1; bit >= 0; --bit)
      prefix = prefix << 1 |
               static_cast<std::uint32_t>(coder.code(contexts[prefix], (value >> bit & 1) != 0));
    return prefix - (1u << width);
  }
};

struct RangeCoder {
  static constexpr int kProbabilityBits = 15;
  static constexpr std::uint32_t kMinRange = 1u << 24;  ///< Below, the coder moves on by a byte.
};

/// Appends to `bytes`, which must outlive it.
class RangeEncoder {
 public:
  explicit RangeEncoder(std::vector<std::byte>& bytes) : bytes_(bytes) {}

  /// Codes a bit. Returns it.
  bool code(AdaptiveBit& context, bool bit) {
    const std::uint32_t bound = (range_ >> RangeCoder::kProbabilityBits) * context.of_one();
    if (bit) {
      range_ = bound;
    } else {
      low_ += bound;
      range_ -= bound;
    }
    context.learn(bit);
    while (range_ < RangeCoder::kMinRange) {
      range_ <<= 8;
      move_on();
    }
    return bit;
  }
  /// Writes the bytes that are left.
  void finish() {
    for (int i = 0; i < 5; ++i) move_on();
  }

 private:
  /// Writes the highest byte of `low_`. Bytes 0xFF wait, because a carry may still reach them.
  void move_on() {
    if (low_ < 0xFF000000u || low_ > 0xFFFFFFFFu) {
      const auto carry = static_cast<std::uint8_t>(low_ >> 32);
      std::uint8_t byte = first_;
      do {
        bytes_.push_back(static_cast<std::byte>(static_cast<std::uint8_t>(byte + carry)));
        byte = 0xFF;
      } while (--waiting_ != 0);
      first_ = static_cast<std::uint8_t>(low_ >> 24);
    }
    ++waiting_;
    low_ = (low_ & 0x00FFFFFFu) << 8;
  }

  std::vector<std::byte>& bytes_;
  std::uint64_t low_ = 0;
  std::uint32_t range_ = 0xFFFFFFFFu;
  std::uint8_t first_ = 0;
  std::uint64_t waiting_ = 1;  ///< The byte `first_` and the bytes 0xFF after it.
};

/// Reads what a RangeEncoder wrote. Any bytes are safe to read: after their end it reads zeros.
class RangeDecoder {
 public:
  explicit RangeDecoder(std::span<const std::byte> bytes) : bytes_(bytes) {
    for (int i = 0; i < 5; ++i) code_ = code_ << 8 | next();
  }

  /// Returns the next bit.
  bool code(AdaptiveBit& context, bool = false) {
    const std::uint32_t bound = (range_ >> RangeCoder::kProbabilityBits) * context.of_one();
    const bool bit = code_ < bound;
    if (bit) {
      range_ = bound;
    } else {
      code_ -= bound;
      range_ -= bound;
    }
    context.learn(bit);
    while (range_ < RangeCoder::kMinRange) {
      range_ <<= 8;
      code_ = code_ << 8 | next();
    }
    return bit;
  }
  /// Returns whether it has read all bytes, and none after them.
  bool is_at_end() const { return at_ == bytes_.size(); }

 private:
  std::uint32_t next() {
    const std::size_t at = at_++;
    return at < bytes_.size() ? std::to_integer<std::uint32_t>(bytes_[at]) : 0;
  }

  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
  std::uint32_t code_ = 0, range_ = 0xFFFFFFFFu;
};

}  // namespace voxdag::wire
