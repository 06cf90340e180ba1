#pragma once
/// An adaptive binary range coder, for the parts of a compact DAG that are read once, from front to
/// back.
///
/// Source: G. N. N. Martin, "Range encoding: an algorithm for removing redundancy from a digitised
/// message", 1979; with the carry propagation and the adaptation (11-bit probabilities, shift by 5)
/// that LZMA uses.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace voxdag {

/// The probability that a bit is 0, in 1/2048, learned from the bits so far.
struct AdaptiveBit {
  std::uint16_t zero = 1024;

  void learn(bool bit) {
    if (bit) {
      zero = static_cast<std::uint16_t>(zero - (zero >> 5));
    } else {
      zero = static_cast<std::uint16_t>(zero + ((2048 - zero) >> 5));
    }
  }
};

class AdaptiveBitWriter {
 public:
  void put(bool bit, AdaptiveBit& context) {
    const std::uint32_t bound = (range_ >> 11) * context.zero;
    if (bit) {
      low_ += bound;
      range_ -= bound;
    } else {
      range_ = bound;
    }
    context.learn(bit);
    normalize();
  }
  /// Writes the lowest `count` bits of `value`, the highest of them first, without a context.
  void put_plain(std::uint64_t value, int count) {
    while (count-- > 0) {
      range_ >>= 1;
      if ((value >> count & 1) != 0) low_ += range_;
      normalize();
    }
  }
  std::vector<std::byte> finish() {
    for (int i = 0; i < 5; ++i) shift();
    return std::move(bytes_);
  }

 private:
  void normalize() {
    while (range_ < 1u << 24) {
      range_ <<= 8;
      shift();
    }
  }
  void shift() {
    if (low_ < 0xFF000000u || low_ >> 32 != 0) {
      const auto carry = static_cast<unsigned>(low_ >> 32);
      if (has_cache_) bytes_.push_back(static_cast<std::byte>(cache_ + carry));
      for (; waiting_ != 0; --waiting_) bytes_.push_back(static_cast<std::byte>(0xFF + carry));
      cache_ = static_cast<unsigned>(low_ >> 24 & 0xFF);
      has_cache_ = true;
    } else {
      ++waiting_;
    }
    low_ = (low_ & 0xFFFFFFu) << 8;
  }

  std::vector<std::byte> bytes_;
  std::uint64_t low_ = 0, waiting_ = 0;
  std::uint32_t range_ = 0xFFFFFFFFu;
  unsigned cache_ = 0;
  bool has_cache_ = false;
};

/// Reads what AdaptiveBitWriter wrote. Past the end it reads zeros and says so in is_past_end().
class AdaptiveBitReader {
 public:
  explicit AdaptiveBitReader(std::span<const std::byte> bytes) : bytes_(bytes) {
    for (int i = 0; i < 4; ++i) code_ = code_ << 8 | next();
  }
  bool get(AdaptiveBit& context) {
    const std::uint32_t bound = (range_ >> 11) * context.zero;
    const bool bit = code_ >= bound;
    if (bit) {
      code_ -= bound;
      range_ -= bound;
    } else {
      range_ = bound;
    }
    context.learn(bit);
    normalize();
    return bit;
  }
  std::uint64_t get_plain(int count) {
    std::uint64_t value = 0;
    while (count-- > 0) {
      range_ >>= 1;
      const bool bit = code_ >= range_;
      if (bit) code_ -= range_;
      value = value << 1 | static_cast<std::uint64_t>(bit);
      normalize();
    }
    return value;
  }
  bool is_past_end() const { return read_ > bytes_.size(); }
  /// Returns whether the reader needed all bytes and no more.
  bool is_at_end() const { return read_ == bytes_.size(); }

 private:
  std::uint32_t next() {
    const std::size_t at = read_++;
    return at < bytes_.size() ? std::to_integer<std::uint32_t>(bytes_[at]) : 0;
  }
  void normalize() {
    while (range_ < 1u << 24) {
      range_ <<= 8;
      code_ = code_ << 8 | next();
    }
  }

  std::span<const std::byte> bytes_;
  std::size_t read_ = 0;
  std::uint32_t code_ = 0, range_ = 0xFFFFFFFFu;
};

/// A number below 2^N, as N bits from the highest on, each in the context of those before it.
template <int N>
struct AdaptiveNumber {
  AdaptiveBit contexts[1 << N];

  void put(AdaptiveBitWriter& out, std::uint32_t value) {
    std::uint32_t node = 1;
    for (int i = N - 1; i >= 0; --i) {
      const bool bit = (value >> i & 1) != 0;
      out.put(bit, contexts[node]);
      node = node << 1 | static_cast<std::uint32_t>(bit);
    }
  }
  std::uint32_t get(AdaptiveBitReader& in) {
    std::uint32_t node = 1;
    for (int i = 0; i < N; ++i)
      node = node << 1 | static_cast<std::uint32_t>(in.get(contexts[node]));
    return node - (1u << N);
  }
};

/// A number of up to 63 bits: the count of its bits as an AdaptiveNumber<6>, then its bits below
/// the leading one, plain.
struct AdaptiveCount {
  AdaptiveNumber<6> width;

  void put(AdaptiveBitWriter& out, std::uint64_t value) {
    int bits = 0;
    while (value >> bits != 0) ++bits;
    width.put(out, static_cast<std::uint32_t>(bits));
    if (bits > 1) out.put_plain(value & ((std::uint64_t{1} << (bits - 1)) - 1), bits - 1);
  }
  std::uint64_t get(AdaptiveBitReader& in) {
    const auto bits = static_cast<int>(width.get(in));
    if (bits <= 1) return static_cast<std::uint64_t>(bits);
    return std::uint64_t{1} << (bits - 1) | in.get_plain(bits - 1);
  }
};

}  // namespace voxdag
