#pragma once
/// The size of the cell that a pixel shows, in one byte: its logarithm in 3.5 fixed point.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 4.3. Uses no
/// library logarithm, because host and device differ in its last bit.
#include <cstdint>

#include "voxdag/core/bits.hpp"

namespace voxdag {

/// Returns 32 log2(side), rounded to the nearest integer, for a side of 1 to 250 pixels. Returns 0
/// for smaller sides and NaN, and 255 for larger sides. Pixels that show no cell also have 0.
VOXDAG_HD inline std::uint8_t pack_cell_pixels(float side) {
  if (!(side > 1.0f)) return 0;
  if (!(side < 256.0f)) return 255;
  float rest = side * 1.010889286f;  // 2^(1/64): rounds the rest to the nearest
  std::uint32_t code = (bits_of_float(rest) >> 23) - 127;
  rest *= float_from_bits((127 - code) << 23);  // scales to [1,2)
  for (int bit = 0; bit < 5; ++bit) {
    rest *= rest;
    code = 2 * code + (rest >= 2.0f ? 1 : 0);
    rest *= rest >= 2.0f ? 0.5f : 1.0f;
  }
  return static_cast<std::uint8_t>(code < 255 ? code : 255);
}

/// Returns the side in pixels: 1 for code 0. Neighbouring codes differ by 1/46 of the side.
VOXDAG_HD inline float unpack_cell_pixels(std::uint8_t code) {
  constexpr float kRoots[5] = {1.021897149f, 1.044273782f, 1.090507733f, 1.189207115f,
                               1.414213562f};  // 2^(1/32), 2^(1/16) and so on
  float side = float_from_bits((127u + (code >> 5)) << 23);
  for (int bit = 0; bit < 5; ++bit)
    if ((code >> bit & 1) != 0) side *= kRoots[bit];
  return side;
}

}  // namespace voxdag
