#pragma once
/// glTF 2.0, as JSON text (.gltf) or binary (.glb).
#include "voxdag/formats/readers/mesh_source.hpp"
#include "voxdag/mesh/appearance.hpp"

namespace voxdag {

/// Reads the triangles (lists, strips and fans, indexed or not) of every mesh that the default
/// scene shows, once per node that shows it, and per instance of EXT_mesh_gpu_instancing. Applies
/// morph weights, and the skin's joints in their rest pose or the product of the nodes' transforms,
/// in double, then rounds to float32. Turns triangles over where the transform mirrors.
/// find_gltf_scene() describes files without a default scene. Resolves sparse and quantised
/// positions. Ignores points, lines, empty primitives and animations. Buffers are in the file, in
/// `data:` URIs or in files in the same folder. If no primitive has a material, the mesh has none;
/// else triangles without a material get a material without a name.
///
/// With its appearance: reads NORMAL, TEXCOORD_n (the set that the material's colour texture uses),
/// COLOR_0 and the materials; opens no images.
///
/// Throws Error with the byte of malformed JSON or the path of the JSON value at fault: accessors
/// beyond their buffers, indices out of range, nodes that do not form trees, missing buffers,
/// required extensions that are not read, no triangles, or at least 2^32 corners or vertices, which
/// even a small file can make by instances.
MeshWithAppearance read_gltf(const MeshSource& source, ReadParts parts);

}  // namespace voxdag
