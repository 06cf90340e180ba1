#include "voxdag/solid/fill_solid.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

#include "voxdag/algebra/components.hpp"
#include "voxdag/algebra/empty_regions.hpp"
#include "voxdag/algebra/rewrite.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/solid/closed_mesh.hpp"
#include "voxdag/solid/parity.hpp"

namespace voxdag {
namespace {

std::string world_text(const Grid& grid, Vec3i units) {
  const Vec3d at = grid.to_world(static_cast<Vec3d>(units) * (1.0 / 256));
  char text[96];
  std::snprintf(text, sizeof text, "(%.6g, %.6g, %.6g)", at.x, at.y, at.z);
  return text;
}

/// Throws Error if the parity of crossings has no meaning.
void check_closed(const QuantizedMesh& mesh, const Grid& grid, MemoryBudget* memory,
                  Progress* progress) {
  if (mesh.triangle_count() != mesh.mesh_triangle_count())
    throw Error("", "", "the mesh reaches too far out of the grid to tell what is inside");
  const OddEdges odd = find_odd_edges(mesh, memory, progress);
  if (odd.count > 0)
    throw Error("", "",
                "the mesh is not closed: " + std::to_string(odd.count) +
                    " edges belong to an odd number of triangles, such as the one from " +
                    world_text(grid, odd.a) + " to " + world_text(grid, odd.b));
}

/// A grid whose voxels are all set.
struct FullGrid {
  static constexpr std::size_t kWords = 1;
  using Key = std::array<std::uint32_t, kWords>;

  static Key root() { return {0}; }
  static void children(int, const Key& key, Key (&keys)[8]) {
    std::fill(std::begin(keys), std::end(keys), key);
  }
  static std::uint64_t block(const Key&) { return ~std::uint64_t{0}; }
};

}  // namespace

Svdag fill_solid(const SvdagView& cover, const Mesh& mesh, const Grid& grid, SolidRule rule,
                 MemoryBudget* memory, Progress* progress) {
  if (rule == SolidRule::kFlood) return fill_cavities(cover, memory, progress);
  const QuantizedMesh quantized(mesh, grid, memory, progress);
  check_closed(quantized, grid, memory, progress);
  if (cover.is_empty()) {
    if (are_inside(quantized, {Vec3i{}}, progress).front())
      return rewrite(FullGrid(), cover.levels, memory, progress);
    Svdag empty;
    empty.levels = cover.levels;
    return empty;
  }
  const EmptyRegions regions(cover, memory, progress);
  return regions.fill(are_inside(quantized, regions.places(), progress));
}

}  // namespace voxdag
