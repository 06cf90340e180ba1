#pragma once
/// The colour and the normal of a voxel before compression.
#include <cstdint>

#include "voxdag/core/vec.hpp"

namespace voxdag {

struct VoxelValue {
  std::uint8_t color[3] = {};  ///< sRGB encoded.
  Vec3f normal{};              ///< Unit length.
};

}  // namespace voxdag
