#pragma once
/// Adds splats to the rows of a brick. Compiled once for each instruction set.
#include <cstdint>

#include "voxdag/builders/splats/splat.hpp"

namespace voxdag {

/// The arrays of a SplatBrick.
struct SplatRows {
  Vec3i first;
  std::uint32_t* touched;
  std::uint64_t* sums;
  std::uint64_t* colors;  ///< Null: none.
};

/// Adds a splat to the sums of SplatBrick.
void add_splat(const SplatRows& rows, const GridSplat& splat);

}  // namespace voxdag
