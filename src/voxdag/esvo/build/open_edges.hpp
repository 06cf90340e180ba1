#pragma once
/// Which edges bound a surface.
#include <cstdint>
#include <span>
#include <vector>

#include "voxdag/voxelize/grid_mapping.hpp"

namespace voxdag {

/// Returns a bit mask for each triangle of the mesh: bit e is set if no other triangle has an edge
/// between the same two points as its edge from corner e to the next. Points are the same if they
/// are rounded to the same 1/256 voxel. Pieces of clipped triangles have no open edges. Triangles
/// with duplicates[i] != 0 (by triangle of the mesh; may be empty) do not count.
std::vector<std::uint8_t> find_open_edges(const QuantizedMesh& mesh,
                                          std::span<const std::uint8_t> duplicates = {});

}  // namespace voxdag
