#pragma once
/// The displacement of materials along the normals of the surface.
#include <memory>
#include <string>
#include <vector>

#include "voxdag/core/memory_budget.hpp"
#include "voxdag/image/texture.hpp"
#include "voxdag/mesh/appearance.hpp"
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

/// A point moves by base + gain * height world units along its normal; heights are 0..1.
struct Displacement {
  std::shared_ptr<const HeightTexture> heights;  ///< Null: nothing moves.
  double base = 0, gain = 0;
  UvTransform uv;  ///< From the corners' texture coordinates to those of the heights.
  /// If positive, texture coordinates are not used: the texture is projected along x, y and z,
  /// covers squares of this many world units, and is blended by the normal.
  double box_size = 0;

  bool moves() const { return heights != nullptr && (base != 0 || gain != 0); }
};

/// Loads the displacement maps of the materials; returns a displacement for each material. A map
/// that cannot be read, or that moves points by more than 2^kMaxLevels times the mesh's longest
/// side, is left out, with a line in `warnings`. `memory`, if not null, counts the heights and must
/// outlive them. Throws Cancelled and OverMemory.
std::vector<Displacement> load_displacements(const Mesh& mesh, const Appearance& appearance,
                                             std::vector<std::string>& warnings,
                                             Progress* progress = nullptr,
                                             MemoryBudget* memory = nullptr);

/// Returns a displacement for each material, by the same heights for all of them and up to `amount`
/// world units (may be negative). A positive `box_size` projects the heights, see Displacement. A
/// mesh without texture coordinates needs that: 0 then means a sixteenth of the mesh's longest
/// side. Throws Error for an amount of more than 2^kMaxLevels times that side.
std::vector<Displacement> displace_all(const Mesh& mesh, const Appearance& appearance,
                                       std::shared_ptr<const HeightTexture> heights, double amount,
                                       double box_size = 0);

}  // namespace voxdag
