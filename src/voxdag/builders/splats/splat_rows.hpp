#pragma once
/// Adds splats to the rows of a brick. Compiled once for each instruction set.
#include <cstdint>

#include "voxdag/builders/splats/splat.hpp"

namespace voxdag {

/// The arrays of a SplatBrick. Eight numbers more than it has voxels may be written.
struct SplatRows {
  Vec3i first;
  std::uint32_t* touched;
  std::uint32_t* set;  ///< Of row y + 32 z: its voxels whose sum is `least`.
  std::uint64_t* sums;
  std::uint64_t* colors;  ///< Null: none.
  std::uint64_t least;
};

/// Adds a splat to the sums of SplatBrick.
void add_splat(const SplatRows& rows, const GridSplat& splat);

}  // namespace voxdag
