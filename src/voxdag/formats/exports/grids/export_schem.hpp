#pragma once
/// Exports voxels as .schem, the Sponge schematic of Minecraft editors.
/// Source: SpongePowered, Schematic Specification, version 2.
#include "voxdag/formats/exports/export_options.hpp"

namespace voxdag {

/// Writes the voxels of the window as blocks; the axes stay as they are, so y is up. Without
/// colours, voxels are stone. With a look that has colours, they are the concrete or terracotta
/// whose mean colour is nearest. Writes the placement beside the output: a schematic has none in
/// the world. Throws Error, before it writes, if a side has more than 32,767 blocks or all have
/// more than 2^31 - 1.
void export_schem(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                  const ExportOptions& options = {});

}  // namespace voxdag
