#pragma once
/// A procedural height texture.
#include <cstdint>

#include "voxdag/image/texture.hpp"

namespace voxdag {

/// Courses of rough stone blocks in mortar, tileable: eight courses over `size` x `size` texels,
/// from 0.1 in the joints to 1. The same on every machine for the same seed. size is at least 64.
HeightTexture make_stone_heights(std::uint32_t seed, int size);

}  // namespace voxdag
