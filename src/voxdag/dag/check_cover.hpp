#pragma once
/// Checks a DAG against the mesh that it was made from.
#include <cstdint>

#include "voxdag/core/grid.hpp"
#include "voxdag/layout/svdag.hpp"
#include "voxdag/mesh/mesh.hpp"
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

struct CoverCheck {
  std::uint64_t samples = 0;     ///< Cells looked at.
  std::uint64_t covered = 0;     ///< Those that a triangle meets.
  std::uint64_t mismatches = 0;  ///< Those where DAG and mesh disagree.
  Vec3i first_mismatch{};        ///< Its cell coordinates, of
  int first_mismatch_level = 0;  ///< this level (L: a voxel); meaningful if mismatches > 0.
};

/// Compares the DAG with triangle_overlaps_cube() over all triangles, in `samples` random cells:
/// voxels on and next to random points of the surface, voxels anywhere, and cells of the four
/// levels above. Shares no code with the builder beyond the quantisation of vertices. Deterministic
/// for a seed.
CoverCheck check_cover(const SvdagView& dag, const Grid& grid, const Mesh& mesh,
                       std::uint64_t samples, std::uint64_t seed = 1, Progress* progress = nullptr);

}  // namespace voxdag
