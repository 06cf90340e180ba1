#pragma once
/// How a surface mirrors light, in the two numbers of glTF's metallic-roughness model.

namespace voxdag {

struct MetallicRoughness {
  float metallic = 0;   ///< 0 to 1: the part of the surface that is bare metal.
  float roughness = 1;  ///< 0 to 1: a mirror to dull.

  friend constexpr bool operator==(const MetallicRoughness&, const MetallicRoughness&) = default;
};

}  // namespace voxdag
