#pragma once
/// Compares a DAG with the mesh that it was built from.
#include <cstdint>

#include "voxdag/core/grid.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/mesh/mesh.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

struct CoverCheck {
  std::uint64_t samples = 0;     ///< Cells compared.
  std::uint64_t covered = 0;     ///< Cells that a triangle meets.
  std::uint64_t mismatches = 0;  ///< Cells where DAG and mesh disagree.
  // Valid if mismatches > 0:
  Vec3i first_mismatch{};        ///< Coordinates of the first such cell.
  int first_mismatch_level = 0;  ///< Its level (L: a voxel).
};

/// Compares the DAG with triangle_overlaps_cube() over all triangles, in `samples` random cells:
/// voxels on and next to random points of the surface, voxels anywhere, and cells of the four
/// levels above. Shares only the quantisation of vertices with the builder. The result depends on
/// the arguments alone. Throws Error if grid and DAG differ in resolution, and Cancelled.
CoverCheck check_cover(const SvdagView& dag, const Grid& grid, const Mesh& mesh,
                       std::uint64_t samples, std::uint64_t seed = 1, Work work = {});

}  // namespace voxdag
