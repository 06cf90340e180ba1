#pragma once
/// How materials are displaced along the normals of the surface.
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
  /// If positive, the texture covers squares of this many world units, projected along x, y and z
  /// and blended by the normal, and texture coordinates are not used.
  double box_size = 0;

  bool moves() const { return heights != nullptr && (base != 0 || gain != 0); }
};

/// By material: what displacement maps the materials have. What cannot be read, or moves points by
/// more than 2^kMaxLevels times the mesh's longest side, is left out, with a line in `warnings`.
/// `memory`, if not null, counts the heights and must outlive them. Throws Cancelled and
/// OverMemory.
std::vector<Displacement> load_displacements(const Mesh& mesh, const Appearance& appearance,
                                             std::vector<std::string>& warnings,
                                             Progress* progress = nullptr,
                                             MemoryBudget* memory = nullptr);

/// By material: the same heights for all of them, up to `amount` world units (may be negative).
/// With a positive `box_size` they are projected, as where the mesh has no texture coordinates:
/// there 0 stands for a sixteenth of the mesh's longest side. Throws Error for an amount of more
/// than 2^kMaxLevels times that side.
std::vector<Displacement> displace_all(const Mesh& mesh, const Appearance& appearance,
                                       std::shared_ptr<const HeightTexture> heights, double amount,
                                       double box_size = 0);

}  // namespace voxdag
