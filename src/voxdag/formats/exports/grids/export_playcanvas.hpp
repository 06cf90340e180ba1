#pragma once
/// Exports voxels as the octree that PlayCanvas's SuperSplat viewer collides with.
/// Source: PlayCanvas, splat-transform, format of .voxel.json and .voxel.bin, version 1.1.
#include "voxdag/formats/exports/export_options.hpp"

namespace voxdag {

/// Writes PATH, which ends in .voxel.json, and beside it the .voxel.bin with the nodes. Equal
/// subtrees are stored once: the reader only descends, so parents can share their children. The
/// bounds place the voxels in the world; the axes stay as they are. `dag` is all that is written:
/// crop it first for a window. Throws Error, before it writes, if the octree has more than 2^24
/// nodes or leaf blocks, which its pointers cannot reach.
void export_playcanvas(const std::filesystem::path& path, const SvdagView& dag, const Grid& grid,
                       const ExportOptions& options = {});

}  // namespace voxdag
