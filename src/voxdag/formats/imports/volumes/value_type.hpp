#pragma once
/// The types of the numbers in dense volumes.
#include <cstddef>
#include <cstdint>

namespace voxdag {

enum class ValueType : std::uint8_t {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
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

}  // namespace voxdag
