#pragma once
/// Wavefront OBJ.
#include "voxdag/mesh/mesh.hpp"
#include "voxdag/readers/mesh_bytes.hpp"

namespace voxdag {

/// Reads the vertices (`v`), the polygons (`f`, every form of reference, negative ones too) and the
/// names of materials (`usemtl`); the MTL file itself is not opened. A polygon becomes a fan around
/// its first corner, which is exact for convex polygons. Points, lines, free-form curves and
/// surfaces, and polygons of fewer than three corners are left out; the fourth and later numbers of
/// a vertex (weight, colour) are ignored, and so are references to texture coordinates and normals.
/// Faces may come before their vertices. A backslash at the end of a line continues it.
///
/// Throws Error with the line: malformed vertices or faces, references out of range, triangles with
/// a vertex that is not finite. Throws Error if there are no triangles.
Mesh read_obj(const MeshBytes& source);

}  // namespace voxdag
