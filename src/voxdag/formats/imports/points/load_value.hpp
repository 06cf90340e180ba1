#pragma once
/// Numbers of binary files.
#include <bit>
#include <cstring>

namespace voxdag {

static_assert(std::endian::native == std::endian::little);

/// Returns the little-endian number at any address.
template <class T>
T load_value(const char* p) {
  T value;
  std::memcpy(&value, p, sizeof value);
  return value;
}

}  // namespace voxdag
