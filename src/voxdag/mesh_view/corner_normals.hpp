#pragma once
/// Smooth normals for a mesh that has none.
#include <array>
#include <vector>

#include "voxdag/mesh/mesh.hpp"
#include "voxdag/mesh_view/packed_normal.hpp"

namespace voxdag {

/// One normal for each corner of each triangle, on the side from which the triangle winds
/// counter-clockwise: the mean of the triangles that meet at the corner's position, weighted by
/// their angles there, of those whose planes differ from the triangle's own by at most
/// `crease_degrees` (0 to 90; 0 gives faces). Which way a neighbour winds does not matter.
/// Vertices at equal positions count as one. Corners of triangles without area get some vector.
/// Deterministic; time and memory in proportion to the triangles.
std::vector<std::array<PackedNormal, 3>> corner_normals(const Mesh& mesh, float crease_degrees);

}  // namespace voxdag
