#pragma once
/// The materials of a glTF asset.
#include "voxdag/formats/readers/gltf/gltf_file.hpp"
#include "voxdag/formats/readers/warnings.hpp"
#include "voxdag/mesh/appearance.hpp"

namespace voxdag {

/// Returns the n of the TEXCOORD_n that a primitive's material uses: the one of its colour texture,
/// else of its normal texture, else of its emissive texture, else of its metallic-roughness
/// texture, else 0.
std::uint64_t gltf_uv_set(const GltfFile& file, const GltfValue& primitive);

/// Fills materials and images: baseColorFactor and -Texture, or the diffuse ones of
/// KHR_materials_pbrSpecularGlossiness, alphaMode and alphaCutoff, emissiveFactor and -Texture with
/// KHR_materials_emissive_strength, normalTexture with its scale, metallicFactor, roughnessFactor
/// and metallicRoughnessTexture, KHR_texture_transform, EXT_texture_webp, wrap modes of samplers;
/// images by URI, data URI and buffer view. Leaves malformed parts, and images outside of the
/// file's folder, out with a warning. Throws OverMemory and Cancelled.
void read_gltf_materials(const GltfFile& file, const Mesh& mesh, Appearance& appearance,
                         Warnings& warnings);

/// Adds the files of images to ReadOptions::named_files without opening them.
void report_gltf_images(const GltfFile& file);

}  // namespace voxdag
