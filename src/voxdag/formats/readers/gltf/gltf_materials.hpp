#pragma once
/// The materials of a glTF asset.
#include "voxdag/formats/readers/gltf/gltf_file.hpp"
#include "voxdag/formats/readers/warnings.hpp"
#include "voxdag/mesh/appearance.hpp"

namespace voxdag {

/// Returns the n of the TEXCOORD_n that a primitive's material uses: the one of its colour texture,
/// else of its normal texture, else 0.
std::uint64_t gltf_uv_set(const GltfFile& file, const GltfValue& primitive);

/// Fills materials and images: baseColorFactor and -Texture, alphaMode and alphaCutoff,
/// normalTexture with its scale, KHR_texture_transform, wrap modes of samplers; images by URI, data
/// URI and buffer view. Leaves malformed parts out with a warning. Throws Error for an image
/// outside of the file's folder, OverMemory, Cancelled.
void read_gltf_materials(const GltfFile& file, const Mesh& mesh, Appearance& appearance,
                         Warnings& warnings);

/// Adds the files of images to ReadOptions::named_files without opening them.
void report_gltf_images(const GltfFile& file);

}  // namespace voxdag
