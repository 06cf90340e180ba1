#pragma once
/// The voxels at which the inside of a mesh with holes ends without a surface.
#include "voxdag/builders/solid/winding/winding_field.hpp"
#include "voxdag/core/page_vector.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// Returns the Morton codes, in ascending order, of voxels that are not in `cover`, such that all
/// voxels of a connected set of the other voxels that are not in `cover` are inside, or none is.
/// They form sheets over the holes: time and memory grow with the sheets and the boundary. `cover`
/// must be the DAG of the mesh. Throws OverMemory and Cancelled.
PageVector<std::uint64_t> find_sheets(const WindingField& field, const SvdagView& cover, Work work);

}  // namespace voxdag
