#pragma once
/// The displacement of materials along the normals of the surface.
#include <memory>
#include <string>
#include <vector>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/image/texture.hpp"
#include "voxdag/mesh/appearance.hpp"

namespace voxdag {

/// A point moves by base + gain * height world units along its normal; heights are 0..1.
struct Displacement {
  std::shared_ptr<const HeightTexture> heights;  ///< Null: nothing moves.
  double base = 0, gain = 0;
  UvTransform uv;  ///< Maps the corners' texture coordinates to the heights'.
  /// If positive, texture coordinates are not used. The texture is projected along x, y and z, and
  /// the projections are blended by the normal. It covers squares of this side, in world units.
  double box_size = 0;

  bool moves() const { return heights != nullptr && (base != 0 || gain != 0); }
};

/// Loads the displacement maps of the materials and returns a displacement for each material.
/// Leaves out a map that cannot be read, or that moves points by more than 2^kMaxLevels times the
/// mesh's longest side; `warnings` gets a line about it. `work` counts the heights as long as they
/// live. Throws Cancelled and OverMemory.
std::vector<Displacement> load_displacements(const Mesh& mesh, const Appearance& appearance,
                                             std::vector<std::string>& warnings, Work work = {});

/// Returns a displacement for each material. All use `heights` and move points by up to `amount`
/// world units, which may be negative. A positive `box_size` projects the heights (see
/// Displacement). A mesh without texture coordinates needs a projection: for it, 0 means a
/// sixteenth of the mesh's longest side. Throws Error if the amount exceeds 2^kMaxLevels times that
/// side.
std::vector<Displacement> displace_all(const Mesh& mesh, const Appearance& appearance,
                                       std::shared_ptr<const HeightTexture> heights, double amount,
                                       double box_size = 0);

}  // namespace voxdag
