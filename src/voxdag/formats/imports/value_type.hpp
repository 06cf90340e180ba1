#pragma once
/// The types of the numbers in dense volumes.
#include <bit>
#include <cstddef>
#include <cstdint>

namespace voxdag {

/// A real number of 16 bits (IEEE 754 binary16): a sign, 5 bits of exponent, 10 of fraction.
struct Half {
  std::uint16_t bits = 0;

  /// Exact: the fraction and exponent move to their places in a float, whose exponents are larger
  /// by 112; the product corrects that also for numbers with the least exponent.
  explicit operator float() const {
    const std::uint32_t magnitude = bits & 0x7FFFu, sign = (bits & 0x8000u) << 16;
    const bool is_finite = magnitude < 0x7C00;
    const float value = is_finite ? std::bit_cast<float>(magnitude << 13) * 0x1p112f
                                  : std::bit_cast<float>(magnitude << 13 | 0x7F800000u);
    return std::bit_cast<float>(std::bit_cast<std::uint32_t>(value) | sign);
  }
  explicit operator double() const { return static_cast<double>(static_cast<float>(*this)); }
};

enum class ValueType : std::uint8_t {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kHalf,
  kFloat,
  kDouble
};

/// Returns what `use` returns for a zero of the type.
template <class Use>
decltype(auto) with_type(ValueType type, const Use& use) {
  switch (type) {
    case ValueType::kInt8:
      return use(std::int8_t{});
    case ValueType::kUint8:
      return use(std::uint8_t{});
    case ValueType::kInt16:
      return use(std::int16_t{});
    case ValueType::kUint16:
      return use(std::uint16_t{});
    case ValueType::kInt32:
      return use(std::int32_t{});
    case ValueType::kUint32:
      return use(std::uint32_t{});
    case ValueType::kInt64:
      return use(std::int64_t{});
    case ValueType::kUint64:
      return use(std::uint64_t{});
    case ValueType::kHalf:
      return use(Half{});
    case ValueType::kFloat:
      return use(float{});
    case ValueType::kDouble:
      break;
  }
  return use(double{});
}

inline std::size_t bytes_of(ValueType type) {
  return with_type(type, [](auto zero) { return sizeof zero; });
}

inline bool is_real(ValueType type) { return type >= ValueType::kHalf; }

}  // namespace voxdag
