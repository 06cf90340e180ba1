#pragma once
/// Counts the voxels of an export before it is written.
#include <cstdint>
#include <functional>

#include "voxdag/stored/svdag/voxel_set.hpp"

namespace voxdag {

/// Returns the number of voxels in the half-open window, or `most` + 1 if there are more than
/// `most`. A DAG is counted node by node, not voxel by voxel: a subtree that occurs many times in
/// the window is walked once. Calls poll() from time to time; it may throw to stop.
std::uint64_t count_voxels(const VoxelSet& voxels, const Box3i& window, std::uint64_t most,
                           const std::function<void()>& poll);

}  // namespace voxdag
