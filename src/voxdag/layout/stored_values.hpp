#pragma once
/// What is stored of a voxel's look.
#include "voxdag/core/srgb.hpp"
#include "voxdag/layout/color_block.hpp"
#include "voxdag/layout/esvo.hpp"
#include "voxdag/layout/normal_block.hpp"

namespace voxdag {

/// Sets `color` to the voxel's, linear in [0,1]. False where none is stored.
VOXDAG_HD inline bool stored_color(const EsvoView& esvo, const EsvoVoxel& voxel, Vec3f& color) {
  const std::uint64_t* block = esvo.attachment(voxel.slot, EsvoAttachmentKind::kColors);
  if (block == nullptr) return false;
  const Vec3f encoded = ColorBlock{*block}.color(attachment_value(voxel));
  color = {srgb_to_linear(encoded.x), srgb_to_linear(encoded.y), srgb_to_linear(encoded.z)};
  return true;
}

/// Likewise its normal, world space, of unit length.
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
