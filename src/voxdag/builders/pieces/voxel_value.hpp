#pragma once
/// The values of a voxel before compression.
#include <cstdint>

#include "voxdag/core/vec.hpp"

namespace voxdag {

struct VoxelValue {
  std::uint8_t color[3] = {};                  ///< sRGB encoded.
  std::uint8_t metallic = 0, roughness = 255;  ///< 255 stands for 1.
  Vec3f normal{};                              ///< Unit length.
};

}  // namespace voxdag
