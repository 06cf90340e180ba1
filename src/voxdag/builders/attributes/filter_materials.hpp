#pragma once
/// Finds the materials of all cells of a DAG: each has the material with the largest area in it.
#include <cstdint>
#include <span>

#include "voxdag/core/grid.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/mesh/mesh.hpp"
#include "voxdag/stored/attributes/cell_index.hpp"
#include "voxdag/stored/attributes/material_ids.hpp"

namespace voxdag {

/// The id of each triangle of a mesh: the number of its object or file.
struct TriangleIds {
  std::span<const std::uint32_t> ids;
  std::uint32_t count = 0;  ///< Ids are less than this, at most kMaxMaterials. 0: no ids.
};

/// Returns the materials of the cells that `index` numbers. `dag` is the DAG of the mesh in `grid`;
/// the mesh has at most kMaxMaterials materials, and one for each triangle. `ids` replace
/// materials, if there are some. If areas are equal, the smallest id counts. Transparency is
/// ignored, as in the shape. The ids depend on mesh, grid and level alone, not on the number of
/// threads. Counts its memory in `work` until it returns. Throws OverMemory and Cancelled.
MaterialIds filter_materials(const Mesh& mesh, const Grid& grid, const SvdagView& dag,
                             const CellIndexView& index, Work work = {},
                             const TriangleIds& ids = {});

}  // namespace voxdag
