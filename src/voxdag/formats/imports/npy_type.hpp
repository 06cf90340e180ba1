#pragma once
/// The types of NumPy's arrays.
#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <optional>
#include <string_view>

#include "voxdag/formats/imports/value_type.hpp"

namespace voxdag {

struct NpyType {
  ValueType value = ValueType::kUint8;
  bool is_swapped = false;  ///< The byte order is not that of this machine.
};

/// Returns the type of bools, integers and real numbers, "<f4" for example; nothing for others.
inline std::optional<NpyType> parse_npy_type(std::string_view dtype) {
  struct NamedType {
    std::string_view name;  ///< Without the byte order.
    ValueType type;
  };
  constexpr NamedType kNames[] = {
      {"b1", ValueType::kUint8},  {"i1", ValueType::kInt8},   {"u1", ValueType::kUint8},
      {"i2", ValueType::kInt16},  {"u2", ValueType::kUint16}, {"i4", ValueType::kInt32},
      {"u4", ValueType::kUint32}, {"i8", ValueType::kInt64},  {"u8", ValueType::kUint64},
      {"f2", ValueType::kHalf},   {"f4", ValueType::kFloat},  {"f8", ValueType::kDouble}};
  const char order = dtype.empty() ? '\0' : dtype[0];
  if (order != '<' && order != '>' && order != '|' && order != '=') return std::nullopt;
  for (const NamedType& named : kNames)
    if (dtype.substr(1) == named.name && (order != '|' || bytes_of(named.type) == 1))
      return NpyType{named.type, (order == '>') != (std::endian::native == std::endian::big) &&
                                     order != '=' && order != '|'};
  return std::nullopt;
}

/// Returns the size of an item of any type that has its size in its name: "<f4", "|V3", "<U5".
inline std::optional<std::uint64_t> bytes_of_npy_type(std::string_view dtype) {
  if (dtype.size() < 3) return std::nullopt;
  const char* const end = dtype.data() + dtype.size();
  std::uint32_t size = 0;
  const auto [next, error] = std::from_chars(dtype.data() + 2, end, size);
  if (error != std::errc() || next != end || size > (1u << 24)) return std::nullopt;
  return dtype[1] == 'U' ? std::uint64_t{4} * size : size;
}

/// Returns the number at any address.
inline double load_number(const NpyType& type, const char* at) {
  return with_type(type.value, [&](auto number) {
    char bytes[sizeof number];
    std::memcpy(bytes, at, sizeof number);
    if (type.is_swapped) std::reverse(bytes, bytes + sizeof number);
    std::memcpy(&number, bytes, sizeof number);
    return static_cast<double>(number);
  });
}

}  // namespace voxdag
