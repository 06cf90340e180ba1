#pragma once
/// Which edges bound a surface.
#include <cstdint>
#include <vector>

#include "voxdag/voxelize/grid_mapping.hpp"

namespace voxdag {

/// For each triangle of the mesh: bit e is set if no other triangle has an edge between the same
/// two points as its edge from corner e to the next. Points count as the same where they are
/// rounded to the same 1/256 voxel. Pieces of triangles that were clipped have no open edges.
std::vector<std::uint8_t> find_open_edges(const QuantizedMesh& mesh);

}  // namespace voxdag
