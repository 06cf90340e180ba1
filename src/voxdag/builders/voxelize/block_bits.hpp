#pragma once
/// 64-bit masks of 4³ voxels. Builders use linear order (bit x + 4y + 16z), in which rows and
/// slices are simple masks. Leaf blocks use Morton order.
#include <cstdint>

#include "voxdag/core/host_device.hpp"
#include "voxdag/core/vec.hpp"

namespace voxdag {

/// Extends sixteen bits u + 4v of a projection's square along the projection's axis, to the voxels
/// of their columns.
VOXDAG_HD VOXDAG_FORCE_INLINE constexpr std::uint64_t expand_square(int projection,
                                                                    std::uint64_t m) {
  if (projection == 2) return m * 0x0001000100010001ull;
  m = (m | m << 24) & 0x000000FF000000FFull;
  m = (m | m << 12) & 0x000F000F000F000Full;
  if (projection == 1) return m * 0x1111ull;
  m = (m | m << 6) & 0x0303030303030303ull;
  m = (m | m << 3) & 0x1111111111111111ull;
  return m * 0xF;
}

/// Returns the voxels of the block at `block` that lie in the box lo..hi (both inclusive), in
/// linear order.
VOXDAG_HD VOXDAG_FORCE_INLINE constexpr std::uint64_t box_mask(Vec3i block, Vec3i lo, Vec3i hi) {
  std::uint64_t bits[3] = {};
  for (int axis = 0; axis < 3; ++axis) {
    const int first = lo[axis] > block[axis] ? lo[axis] - block[axis] : 0;
    const int last = hi[axis] < block[axis] + 3 ? hi[axis] - block[axis] : 3;
    if (first > last) return 0;
    bits[axis] = (2ull << last) - (1ull << first);
  }
  const std::uint64_t y = (bits[1] | bits[1] << 3 | bits[1] << 6 | bits[1] << 9) & 0x1111;
  const std::uint64_t z =
      (bits[2] | bits[2] << 15 | bits[2] << 30 | bits[2] << 45) & 0x0001000100010001ull;
  return bits[0] * y * z;
}

namespace detail {

/// Exchanges the bits at positions with the index bits (i, j) = (0, 1) and those at positions with
/// (1, 0).
template <int i, int j>
VOXDAG_HD constexpr std::uint64_t swap_index_bits(std::uint64_t m) {
  constexpr int kShift = (1 << i) - (1 << j);
  constexpr std::uint64_t kMoved = [] {
    std::uint64_t moved = 0;
    for (int p = 0; p < 64; ++p)
      if (((p >> i) & 1) == 0 && ((p >> j) & 1) == 1) moved |= 1ull << p;
    return moved;
  }();
  const std::uint64_t t = (m ^ (m >> kShift)) & kMoved;
  return m ^ t ^ (t << kShift);
}

}  // namespace detail

/// Converts linear to Morton order: index bits z1 z0 y1 y0 x1 x0 become z1 y1 x1 z0 y0 x0.
VOXDAG_HD VOXDAG_FORCE_INLINE constexpr std::uint64_t linear_to_morton(std::uint64_t m) {
  m = detail::swap_index_bits<4, 3>(m);
  m = detail::swap_index_bits<3, 1>(m);
  return detail::swap_index_bits<2, 1>(m);
}

}  // namespace voxdag
