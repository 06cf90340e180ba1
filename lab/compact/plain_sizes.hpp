#pragma once
/// Sizes of the SVO and of the SVDAG as the SVDAG paper counts them.
///
/// Viktor Kämpe, Erik Sintorn and Ulf Assarsson: High Resolution Sparse Voxel DAGs, SIGGRAPH 2013,
/// Section 5 and Table 2.
#include "lab/runs/size_in_parts.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag::lab {

/// Returns the size of the octree without pointers: a byte, the child mask, for each node down to
/// those of 2³ voxels. Nothing can walk it at random; it is the bound of all pointered octrees.
SizeInParts svo_size(const SvdagView& dag);

/// Returns the size of the layout of files and rays (stored/svdag/svdag.hpp): 4 bytes for each mask
/// and each pointer, 8 for each leaf block of 4³ voxels.
SizeInParts svdag_size(const SvdagView& dag);

}  // namespace voxdag::lab
