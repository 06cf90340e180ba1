#pragma once
/// The size of the cell that a pixel shows, in one byte: its logarithm in 3.5 fixed point.
///
/// Source: Laine, Karras, "Efficient Sparse Voxel Octrees", I3D 2010, Section 4.3.
/// Without the logarithms of libraries, which differ in the last bit between host and device.
#include <cstdint>

#include "voxdag/core/bits.hpp"

namespace voxdag {

/// A side in pixels, from 1 to 250, as 32 log2(side) to the nearest integer. Smaller sides, and
/// what is no number, are 0, and larger ones 255. Zero is also for pixels that show no cell.
VOXDAG_HD inline std::uint8_t pack_cell_pixels(float side) {
  if (!(side > 1.0f)) return 0;
  if (!(side < 256.0f)) return 255;
  float rest = side * 1.010889286f;  // 2^(1/64): rounds what follows to the nearest
  std::uint32_t code = (bits_of_float(rest) >> 23) - 127;
  rest *= float_from_bits((127 - code) << 23);  // to [1,2)
  for (int bit = 0; bit < 5; ++bit) {
    rest *= rest;
    code = 2 * code + (rest >= 2.0f ? 1 : 0);
    rest *= rest >= 2.0f ? 0.5f : 1.0f;
  }
  return static_cast<std::uint8_t>(code < 255 ? code : 255);
}

/// The side in pixels: 1 for 0, and a step is a 46th of it.
VOXDAG_HD inline float unpack_cell_pixels(std::uint8_t code) {
  constexpr float kRoots[5] = {1.021897149f, 1.044273782f, 1.090507733f, 1.189207115f,
                               1.414213562f};  // 2^(1/32), 2^(1/16) and so on
  float side = float_from_bits((127u + (code >> 5)) << 23);
  for (int bit = 0; bit < 5; ++bit)
    if ((code >> bit & 1) != 0) side *= kRoots[bit];
  return side;
}

}  // namespace voxdag
