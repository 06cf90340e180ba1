#pragma once
/// Removes the voxels whose surface the alpha test removes.
#include <optional>

#include "voxdag/core/grid.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/mesh/mesh.hpp"
#include "voxdag/mesh/surface/surface_shading.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// Returns the voxels of `dag`, the DAG of `mesh` in `grid`, in which a part of the surface passes
/// the alpha test of `shading`. Returns nothing if these are all voxels. The result depends on
/// mesh, shading and grid alone, not on the number of threads. Counts its memory in `work` until it
/// returns. Throws OverMemory and Cancelled.
std::optional<Svdag> cut_alpha(const Mesh& mesh, const Grid& grid, const SvdagView& dag,
                               const SurfaceShading& shading, Work work = {});

}  // namespace voxdag
