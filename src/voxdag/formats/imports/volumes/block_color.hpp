#pragma once
/// Colours for the blocks of Minecraft.
#include <string_view>

#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

/// Returns a colour for a block, such as "minecraft:oak_stairs[half=top]": that of export_schem()
/// for the blocks that it writes; else about the mean of the texture, by the words of the name;
/// grey for unknown names.
Rgb8 color_of_block(std::string_view name);

/// Returns whether a block is one of the kinds of air, which set no voxel.
bool is_air(std::string_view name);

}  // namespace voxdag
