#pragma once
/// The attributes of a voxel before they are compressed.
#include <cstdint>

#include "voxdag/core/vec.hpp"

namespace voxdag {

struct VoxelValue {
  std::uint8_t color[3] = {};  ///< sRGB encoded.
  Vec3f normal{};              ///< Unit length.
};

}  // namespace voxdag
