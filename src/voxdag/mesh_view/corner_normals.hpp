#pragma once
/// Computes smooth normals for a mesh without normals.
#include <array>
#include <vector>

#include "voxdag/mesh/mesh.hpp"
#include "voxdag/mesh_view/packed_normal.hpp"

namespace voxdag {

/// Returns one normal for each corner of each triangle, on the side from which the triangle winds
/// counter-clockwise. A normal is the mean over the triangles that meet at the corner's position,
/// weighted by their angles there. It includes only triangles whose planes differ from the corner's
/// triangle by at most `crease_degrees` (0 to 90; 0 gives flat normals). The winding of neighbours
/// does not matter. Vertices at equal positions count as one. Corners of triangles without area get
/// an arbitrary vector. Deterministic; time and memory are proportional to the number of triangles.
std::vector<std::array<PackedNormal, 3>> corner_normals(const Mesh& mesh, float crease_degrees);

}  // namespace voxdag
