#pragma once
/// The properties of a PLY element that hold a colour, by the names that programs give them.
#include <array>
#include <initializer_list>
#include <string_view>
#include <vector>

#include "voxdag/formats/readers/ply/ply_header.hpp"
#include "voxdag/formats/readers/text_scan.hpp"

namespace voxdag {

/// The factor of the first spherical harmonic. The colour of a Gaussian splat is
/// kSplatMiddle + kHarmonic * f_dc, in sRGB.
inline constexpr double kHarmonic = 0.28209479177387814, kSplatMiddle = 0.5;

/// Returns the indices of scalar properties by name, in any letter case; empty if one is missing or
/// a list.
inline std::vector<int> find_ply_scalars(const PlyElement& element,
                                         std::initializer_list<std::string_view> names) {
  std::vector<int> found;
  for (const std::string_view name : names) {
    const int property = element.find({name});
    if (property < 0 || element.properties[property].count_type) return {};
    found.push_back(property);
  }
  return found;
}

/// Returns the indices of red, green, blue and, if there is one, alpha; empty without colours.
inline std::vector<int> find_ply_color(const PlyElement& element) {
  for (const auto& names :
       {std::array{"red", "green", "blue", "alpha"},
        std::array{"diffuse_red", "diffuse_green", "diffuse_blue", "diffuse_alpha"},
        std::array{"r", "g", "b", "a"}}) {
    std::vector<int> found = find_ply_scalars(element, {names[0], names[1], names[2]});
    if (found.empty()) continue;
    const std::vector<int> alpha = find_ply_scalars(element, {names[3]});
    found.insert(found.end(), alpha.begin(), alpha.end());
    return found;
  }
  return {};
}

/// Returns the indices of the colour of Gaussian splats; empty without it.
inline std::vector<int> find_splat_color(const PlyElement& element) {
  return find_ply_scalars(element, {"f_dc_0", "f_dc_1", "f_dc_2"});
}

/// Returns the factor that maps a component of a colour to 0..1.
inline float ply_color_scale(PlyType type) {
  switch (type) {
    case PlyType::kInt8:
    case PlyType::kUint8:
      return 1.0f / 255;
    case PlyType::kInt16:
    case PlyType::kUint16:
      return 1.0f / 65535;
    default:
      return is_integer(type) ? 1.0f / 255 : 1.0f;
  }
}

}  // namespace voxdag
