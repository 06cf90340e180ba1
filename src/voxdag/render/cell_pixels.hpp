#pragma once
/// The size of the cell that a pixel shows, in one byte: its logarithm in 3.5 fixed point.
///
/// Source: Laine, Karras, "Efficient Sparse Voxel Octrees", I3D 2010, Section 4.3.
#include <cmath>
#include <cstdint>

#include "voxdag/core/host_device.hpp"

namespace voxdag {

/// A side in pixels, from 1 to 250, as 32 log2(side) to the nearest integer. Smaller sides, and
/// what is no number, are 0, and larger ones 255. Zero is also for pixels that show no cell.
VOXDAG_HD inline std::uint8_t pack_cell_pixels(float side) {
  if (!(side > 1.0f)) return 0;
  const float code = std::log2(side) * 32.0f + 0.5f;
  return code < 255.0f ? static_cast<std::uint8_t>(code) : std::uint8_t{255};
}

/// The side in pixels: 1 for 0, and a step is a 46th of it.
VOXDAG_HD inline float unpack_cell_pixels(std::uint8_t code) {
  return std::exp2(static_cast<float>(code) * (1.0f / 32.0f));
}

}  // namespace voxdag
