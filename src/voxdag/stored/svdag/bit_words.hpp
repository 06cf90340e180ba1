#pragma once
/// Numbers of any width in an array of 64-bit words, from the lowest bit of each word up.
#include <cstdint>

#include "voxdag/core/host_device.hpp"

namespace voxdag {

/// Returns the number of `width` bits, 0 to 64, that begins at bit `bit`. Reads the word after the
/// number's first word only if the number reaches into it.
VOXDAG_HD inline std::uint64_t read_bits(const std::uint64_t* words, std::uint64_t bit, int width) {
  if (width == 0) return 0;
  const std::uint64_t at = bit >> 6;
  const int shift = static_cast<int>(bit & 63);
  std::uint64_t value = words[at] >> shift;
  if (shift + width > 64) value |= words[at + 1] << (64 - shift);
  return width == 64 ? value : value & ((std::uint64_t{1} << width) - 1);
}

/// Sets the number of `width` bits, 0 to 64, that begins at bit `bit`, to `value`, which must fit.
/// All these bits must be zero before.
inline void write_bits(std::uint64_t* words, std::uint64_t bit, int width, std::uint64_t value) {
  if (width == 0) return;
  const std::uint64_t at = bit >> 6;
  const int shift = static_cast<int>(bit & 63);
  words[at] |= value << shift;
  if (shift + width > 64) words[at + 1] |= value >> (64 - shift);
}

}  // namespace voxdag
