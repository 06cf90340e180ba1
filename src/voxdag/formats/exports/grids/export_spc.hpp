#pragma once
/// Exports voxels as the octree of kaolin's structured point clouds (SPC).
/// Source: NVIDIA, Kaolin library, kaolin.rep.Spc.
#include "voxdag/formats/exports/export_options.hpp"

namespace voxdag {

/// Writes the octree as .npy, an array of uint8: a byte for each node of levels 0 to L-1, breadth
/// first, in Morton order with z as the lowest bit. Bit 4x + 2y + z of a byte is child (x, y, z).
/// Writes the placement beside it. `dag` is all that is written: crop it first for a window. Throws
/// Error, before it writes, for a grid of more than 2^15 voxels a side: kaolin's coordinates have
/// 16 bits.
void export_spc(const std::filesystem::path& path, const SvdagView& dag, const Grid& grid,
                const ExportOptions& options = {});

}  // namespace voxdag
