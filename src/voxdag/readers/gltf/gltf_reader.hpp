#pragma once
/// glTF 2.0, as JSON text (.gltf) or binary (.glb).
#include "voxdag/mesh/appearance.hpp"
#include "voxdag/readers/mesh_source.hpp"

namespace voxdag {

/// Reads the triangles (lists, strips and fans, indexed or not) of every mesh that the default
/// scene shows, once for each node that shows it, under the product of the nodes' transforms:
/// computed in double, then rounded to float32. Without a default scene the first one is read,
/// without scenes all root nodes, without nodes all meshes. Sparse and quantised positions are
/// resolved. Points and lines are left out; skins, morph targets and animations are not applied;
/// images are not opened. Buffers are in the file, in `data:` URIs or in files beside it. A mesh
/// without any material has none; else triangles without one have the unnamed material.
///
/// Throws Error with the byte of malformed JSON or the path of the JSON value at fault: accessors
/// beyond their buffers, indices out of range, vertices that are used and not finite, nodes that do
/// not form trees, missing buffers, required extensions that change geometry (Draco, meshopt).
/// Throws Error if there are no triangles.
///
/// With its appearance: NORMAL, TEXCOORD_n (the set that a material's colour texture uses), COLOR_0
/// and the materials.
MeshWithAppearance read_gltf(const MeshSource& source, ReadParts parts);

}  // namespace voxdag
