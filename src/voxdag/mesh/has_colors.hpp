#pragma once
/// Tells whether a mesh file describes colours.
#include <algorithm>

#include "voxdag/mesh/appearance.hpp"

namespace voxdag {

/// Returns whether corners have colours, or a material has a texture, an emission, or another
/// colour than white and kDefaultColor.
inline bool has_colors(const Appearance& appearance) {
  const auto is_colored = [](const Material& material) {
    const Vec3f color = material.base_color;
    return material.color_map.exists() || material.emission_map.exists() ||
           material.emission != Vec3f{} || (color != Vec3f{1, 1, 1} && color != kDefaultColor);
  };
  return !appearance.colors.empty() ||
         std::any_of(appearance.materials.begin(), appearance.materials.end(), is_colored);
}

/// Returns whether all materials are white, as in glTF without colours, if has_colors() is false.
inline bool is_white(const Appearance& appearance) {
  return !appearance.materials.empty() &&
         std::all_of(appearance.materials.begin(), appearance.materials.end(),
                     [](const Material& material) {
                       return material.base_color == Vec3f{1, 1, 1};
                     });
}

/// Returns whether a material has a metallic or roughness other than the default, or a texture of
/// them.
inline bool has_metallic_roughness(const Appearance& appearance) {
  return std::any_of(appearance.materials.begin(), appearance.materials.end(),
                     [](const Material& material) {
                       return material.metallic_roughness != MetallicRoughness{} ||
                              material.metallic_map.exists() || material.roughness_map.exists();
                     });
}

}  // namespace voxdag
