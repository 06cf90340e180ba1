#pragma once
/// The materials of formats that have none, and colours whose range no file states.
#include <algorithm>
#include <string>

#include "voxdag/formats/readers/mesh_source.hpp"
#include "voxdag/image/color.hpp"
#include "voxdag/mesh/appearance.hpp"

namespace voxdag {

/// Returns the factor that maps the components of a file's colours to 0..1. Numbers from 0 to 1 and
/// numbers from 0 to 255 are both common; the greatest component of the file decides. Some programs
/// write slightly more than 1.
inline float plain_color_scale(float greatest) { return greatest > 1.5f ? 1.0f / 255 : 1.0f; }

/// Returns the warning about colours, of floats or of more than 8 bits, that go from 0 to 255.
inline std::string colors_to_255_warning(const std::string& file) {
  return file + ": the components of colours are taken as 0 to 255";
}

/// Converts a colour in sRGB, 0..1.
inline Rgba16 from_srgb(Vec3f rgb, float alpha = 1) {
  return to_rgba16({srgb_to_linear(rgb.x), srgb_to_linear(rgb.y), srgb_to_linear(rgb.z)}, alpha);
}

/// Adds materials with the names of the mesh: white under colours of corners, else grey. Throws
/// OverMemory.
inline void add_plain_materials(const MeshSource& source, MeshWithAppearance& read) {
  const std::vector<std::string>& names = read.mesh.materials;
  const MemoryReservation counted(source.work().memory, names.size() * sizeof(Material));
  std::vector<Material>& materials = read.appearance.materials;
  materials.resize(std::max<std::size_t>(names.size(), 1));
  for (std::size_t i = 0; i < names.size(); ++i) materials[i].name = names[i];
  if (!read.appearance.colors.empty()) return;
  for (Material& material : materials) material.base_color = kDefaultColor;
}

}  // namespace voxdag
