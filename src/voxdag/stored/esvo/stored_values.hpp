#pragma once
/// Reads the colour and the normal that an ESVO stores for a voxel.
#include "voxdag/core/srgb.hpp"
#include "voxdag/stored/esvo/color_block.hpp"
#include "voxdag/stored/esvo/esvo.hpp"
#include "voxdag/stored/esvo/normal_block.hpp"

namespace voxdag {

/// Returns whether the octree stores values of this kind. It stores them for all voxels or for
/// none.
VOXDAG_HD inline bool has_stored(const EsvoView& esvo, EsvoAttachmentKind kind) {
  return !esvo.is_empty() && esvo.attachment(esvo.root, kind) != nullptr;
}

/// Sets `color` to the voxel's colour as stored: sRGB-encoded, in [0,1]. Returns false if the ESVO
/// stores no colours.
VOXDAG_HD inline bool stored_srgb(const EsvoView& esvo, const EsvoVoxel& voxel, Vec3f& color) {
  const std::uint64_t* block = esvo.attachment(voxel.slot, EsvoAttachmentKind::kColors);
  if (block == nullptr) return false;
  color = ColorBlock{*block}.color(attachment_value(voxel));
  return true;
}

/// Sets `color` to the voxel's colour as in image files: sRGB, 8 bits per channel. Returns false if
/// the ESVO stores no colours.
VOXDAG_HD inline bool stored_srgb8(const EsvoView& esvo, const EsvoVoxel& voxel,
                                   Vec3<std::uint8_t>& color) {
  Vec3f encoded;
  if (!stored_srgb(esvo, voxel, encoded)) return false;
  for (int i = 0; i < 3; ++i) color[i] = static_cast<std::uint8_t>(255 * encoded[i] + 0.5f);
  return true;
}

/// Sets `color` to the voxel's colour in linear light, in [0,1]. Returns false if the ESVO stores
/// no colours.
VOXDAG_HD inline bool stored_color(const EsvoView& esvo, const EsvoVoxel& voxel, Vec3f& color) {
  Vec3f encoded;
  if (!stored_srgb(esvo, voxel, encoded)) return false;
  color = {srgb_to_linear(encoded.x), srgb_to_linear(encoded.y), srgb_to_linear(encoded.z)};
  return true;
}

/// Sets `normal` to the voxel's normal: world space, unit length. Returns false if the ESVO stores
/// no normals.
VOXDAG_HD inline bool stored_normal(const EsvoView& esvo, const EsvoVoxel& voxel, Vec3f& normal) {
  const std::uint64_t* block = esvo.attachment(voxel.slot, EsvoAttachmentKind::kNormals);
  if (block == nullptr) return false;
  const NormalBlock normals{
      {static_cast<std::uint32_t>(block[0]), static_cast<std::uint32_t>(block[0] >> 32),
       static_cast<std::uint32_t>(block[1]), static_cast<std::uint32_t>(block[1] >> 32)}};
  normal = normals.normal(attachment_value(voxel));
  return true;
}

}  // namespace voxdag
