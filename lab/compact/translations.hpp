#pragma once
/// Finds the cubes that are moved images of other cubes.
///
/// Mathijs Molenaar and Elmar Eisemann: Transform-Aware Sparse Voxel Directed Acyclic Graphs, I3D
/// 2025. A cube X can be made from a cube P if X is P under a symmetry, then moved by whole voxels;
/// voxels that leave the cube are lost. The cubes are ordered by their number of voxels, most
/// first, and X is made from the first possible P of that order, which may be X itself.
///
/// The search here is another than in the paper and finds the same. A move leaves layers of X
/// empty, so X must have empty layers at its faces. If a move goes to lower coordinates on all
/// axes, the voxels of X are those that are seen in P from a corner on, in the positive direction
/// of each axis. Each P, mirrored in all 8 ways, looks up a polynomial hash of its view from each
/// corner among the hashes of the voxels of the 48 images of all X.
#include <cstdint>
#include <vector>

#include "lab/compact/cube_grid.hpp"
#include "voxdag/core/parallel/progress.hpp"

namespace voxdag::lab {

/// Returns for each cube the index of the cube that it is made from. The cubes are of one size, not
/// empty, and none is the image of another under a symmetry alone. The result does not depend on
/// the number of threads. Throws Cancelled.
std::vector<std::uint32_t> find_sources(const std::vector<CubeGrid>& cubes,
                                        const Progress& progress);

/// A symmetry, then a move.
struct Transform {
  std::uint8_t symmetry = 0;
  Vec3i move;

  friend bool operator==(const Transform&, const Transform&) = default;
};

/// Returns the first transform that makes `cube` from `source`: the smallest symmetry, then the
/// smallest move on z, on y, on x. Asserts that there is one.
Transform first_transform(const CubeGrid& source, const CubeGrid& cube);

}  // namespace voxdag::lab
