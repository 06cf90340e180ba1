#pragma once
/// PLY, the Polygon File Format.
#include "voxdag/mesh/mesh.hpp"
#include "voxdag/readers/mesh_bytes.hpp"

namespace voxdag {

/// Reads x, y and z of element `vertex` and the list `vertex_indices` (or `vertex_index`) of
/// element `face`, in ascii and in both binary orders; other elements and properties are passed
/// over. A coordinate of another type becomes the nearest float32. A polygon becomes a fan around
/// its first corner, which is exact for convex polygons; polygons of fewer than three corners are
/// left out. Comments `material NUMBER NAME`, numbered from 0, with a face property
/// `material_index` give the materials. In ascii each row is one line.
///
/// Throws Error with the line (the byte in a binary body): malformed headers and values, counts
/// that the file is too short for, truncation, references out of range, triangles with a vertex
/// that is not finite, triangle strips. Throws Error if there are no triangles.
Mesh read_ply(const MeshBytes& source);

}  // namespace voxdag
