#pragma once
/// A procedural height texture of a stone wall.
#include <cstdint>

#include "voxdag/image/texture.hpp"

namespace voxdag {

/// Returns a tileable height image of `size` x `size` texels: eight courses of rough stone blocks
/// in mortar, from 0.1 in the joints to 1. It depends on the seed alone. `size` is at least 64.
HeightTexture make_stone_heights(std::uint32_t seed, int size);

}  // namespace voxdag
