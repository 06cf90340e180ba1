#pragma once
/// Morton (Z-order) codes of up to 21 bits per axis. Bit i of x becomes bit 3i, bit i of y bit
/// 3i+1, bit i of z bit 3i+2. So each group of three bits, from the top, is the child index (x=1,
/// y=2, z=4) of one octree level.
#include <cstdint>

#include "voxdag/core/vec.hpp"

namespace voxdag {

/// Spreads the low 21 bits of v: bit i moves to bit 3i, the bits between are zero.
VOXDAG_HD constexpr std::uint64_t spread_bits3(std::uint64_t v) {
  v &= 0x1FFFFF;
  v = (v | v << 32) & 0x001F00000000FFFFull;
  v = (v | v << 16) & 0x001F0000FF0000FFull;
  v = (v | v << 8) & 0x100F00F00F00F00Full;
  v = (v | v << 4) & 0x10C30C30C30C30C3ull;
  v = (v | v << 2) & 0x1249249249249249ull;
  return v;
}

/// Gathers bits 0, 3, 6, ...: the inverse of spread_bits3.
VOXDAG_HD constexpr std::uint32_t gather_bits3(std::uint64_t v) {
  v &= 0x1249249249249249ull;
  v = (v | v >> 2) & 0x10C30C30C30C30C3ull;
  v = (v | v >> 4) & 0x100F00F00F00F00Full;
  v = (v | v >> 8) & 0x001F0000FF0000FFull;
  v = (v | v >> 16) & 0x001F00000000FFFFull;
  v = (v | v >> 32) & 0x1FFFFF;
  return static_cast<std::uint32_t>(v);
}

/// Returns the code of coordinates in [0, 2^21).
VOXDAG_HD constexpr std::uint64_t morton_encode(Vec3i p) {
  return spread_bits3(static_cast<std::uint32_t>(p.x)) |
         spread_bits3(static_cast<std::uint32_t>(p.y)) << 1 |
         spread_bits3(static_cast<std::uint32_t>(p.z)) << 2;
}

/// Returns the coordinates of a code: the inverse of morton_encode.
VOXDAG_HD constexpr Vec3i morton_decode(std::uint64_t code) {
  return {static_cast<std::int32_t>(gather_bits3(code)),
          static_cast<std::int32_t>(gather_bits3(code >> 1)),
          static_cast<std::int32_t>(gather_bits3(code >> 2))};
}

/// Returns the position of child `index` (0..7: bits x=1, y=2, z=4) within its parent: each
/// coordinate is 0 or 1.
VOXDAG_HD constexpr Vec3i child_offset(int index) {
  return {index & 1, index >> 1 & 1, index >> 2};
}

/// Returns the child index (0..7) made of bit `shift` of each coordinate. With shift 0 it is the
/// cell's index in its parent, with shift s the index of the ancestor s levels up in its own
/// parent.
VOXDAG_HD constexpr int child_index(Vec3i cell, int shift) {
  return (cell.x >> shift & 1) | (cell.y >> shift & 1) << 1 | (cell.z >> shift & 1) << 2;
}

}  // namespace voxdag
