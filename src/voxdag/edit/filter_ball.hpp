#pragma once
/// Smooths, grows and shrinks what a ball holds.
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/edit/shapes.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

enum class BallFilter {
  kSmooth,  ///< A voxel is set if at least 14 of the 27 voxels around it, itself included, are.
  kGrow,    ///< Adds all voxels that share a face with a voxel.
  kShrink,  ///< Removes all voxels that share a face with a place without a voxel.
};

/// The largest radius of a ball to filter, in voxels.
inline constexpr std::int64_t kMaxFilterRadius = 256;

/// Returns the voxels of the ball after the filter: those outside of it count as neighbours and do
/// not change. There are no voxels outside the grid. Takes a byte of memory for each voxel of the
/// ball's box. Throws Error for a ball that is too large, OverMemory and Cancelled.
Svdag filter_ball(const SvdagView& dag, const BallShape& ball, BallFilter filter, Work work = {});

}  // namespace voxdag
