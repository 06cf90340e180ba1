#pragma once
/// The arrays of a glTF asset.
#include <array>
#include <cstdint>
#include <vector>

#include "voxdag/core/vec.hpp"
#include "voxdag/core/vec2.hpp"
#include "voxdag/readers/gltf/gltf_file.hpp"

namespace voxdag {

/// Number of elements that an accessor declares; throws Error if it is 0 or over 2^32 - 2.
std::uint32_t gltf_count(const GltfValue& accessor);

/// Positions: VEC3 of float, or of 8- or 16-bit integers where the asset uses
/// KHR_mesh_quantization. Sparse values are put in place. Every range is checked against its
/// buffer. Throws Error.
std::vector<Vec3f> read_gltf_positions(const GltfFile& file, const GltfValue& accessor);

/// Texture coordinates (VEC2), normals (VEC3) and colours (VEC3 or VEC4; linear light), of any
/// component type; as above.
std::vector<Vec2f> read_gltf_uvs(const GltfFile& file, const GltfValue& accessor);
std::vector<Vec3f> read_gltf_normals(const GltfFile& file, const GltfValue& accessor);
std::vector<std::array<float, 4>> read_gltf_colors(const GltfFile& file, const GltfValue& accessor);

/// Indices: SCALAR of unsigned 8, 16 or 32 bits; as above. The indices themselves are not checked.
std::vector<std::uint32_t> read_gltf_indices(const GltfFile& file, const GltfValue& accessor);

}  // namespace voxdag
