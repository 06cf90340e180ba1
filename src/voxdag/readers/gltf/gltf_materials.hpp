#pragma once
/// The materials of a glTF asset.
#include <string>
#include <vector>

#include "voxdag/mesh/appearance.hpp"
#include "voxdag/readers/gltf/gltf_file.hpp"

namespace voxdag {

/// Which TEXCOORD_n a primitive's material looks up: that of its colour texture, else of its normal
/// texture, else 0.
std::uint64_t gltf_uv_set(const GltfFile& file, const GltfValue& primitive);

/// Fills materials and images: baseColorFactor and -Texture, alphaMode and alphaCutoff,
/// normalTexture with its scale, KHR_texture_transform, wrap modes of samplers; images by URI, data
/// URI and buffer view. What is malformed is left out with a warning.
void read_gltf_materials(const MeshSource& source, const GltfFile& file, const Mesh& mesh,
                         Appearance& appearance, std::vector<std::string>& warnings);

}  // namespace voxdag
