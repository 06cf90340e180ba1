#pragma once
/// The stored colours and normals of cubes.
#include "voxdag/render/view_sample.hpp"
#include "voxdag/stored/attributes/look.hpp"

namespace voxdag {

/// The rule of is_of_back(): cosines of angles.
struct BackRule {
  /// A normal is of the back if it points away from the viewer by more than this.
  static constexpr float kLeaning = 0.2f;
  /// A normal that points away from the viewer at all is of the back if it points into the cube by
  /// more than this.
  static constexpr float kOpposite = 0.8f;
};

/// Returns whether the stored normal of a cube belongs to the side of the surface that the viewer
/// does not see. `view` points to the viewer, `entered` is the normal of the cube's entered face;
/// all have unit length.
///
/// Surfaces are visible from both sides, and the entered face does not tell reliably which side is
/// seen. At outlines, where most cube faces are visible, a normal of the front can point away from
/// the viewer a little, but not straight into the cube from the entered face.
VOXDAG_HD inline bool is_of_back(Vec3f normal, Vec3f view, Vec3f entered) {
  const float facing = dot(normal, view), outward = dot(normal, entered);
  if (facing < -BackRule::kLeaning) return true;
  return facing < 0 && outward < -BackRule::kOpposite;
}

/// Sets the colour, the normal for shading, metallic and roughness of a sample at cell `cell` of
/// `level` to those that `look` stores there, as far as it stores any. The other parameters are
/// those of is_of_back().
VOXDAG_HD inline void set_stored_look(const LookView& look, Vec3i cell, int level, Vec3f view,
                                      Vec3f entered, ViewSample& sample) {
  const StoredLook stored = look_at(look, cell, level);
  if (stored.has_color)
    for (int c = 0; c < 3; ++c) sample.albedo[c] = srgb_to_linear(stored.color[c]);
  sample.metallic_roughness = stored.metallic_roughness;
  if (!stored.has_normal) return;
  sample.normal = is_of_back(stored.normal, view, entered) ? -stored.normal : stored.normal;
}

}  // namespace voxdag
