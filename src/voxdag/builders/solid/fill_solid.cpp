#include "voxdag/builders/solid/fill_solid.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

#include "voxdag/algebra/combine.hpp"
#include "voxdag/algebra/components.hpp"
#include "voxdag/algebra/empty_regions.hpp"
#include "voxdag/algebra/rewrite.hpp"
#include "voxdag/algebra/voxels/voxel_builder.hpp"
#include "voxdag/builders/solid/closed_mesh.hpp"
#include "voxdag/builders/solid/parity.hpp"
#include "voxdag/builders/solid/winding/winding_field.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/core/parallel/polled_for.hpp"

namespace voxdag {
namespace {

std::string world_text(const Grid& grid, Vec3i units) {
  const Vec3d at = grid.to_world(static_cast<Vec3d>(units) * (1.0 / 256));
  char text[96];
  std::snprintf(text, sizeof text, "(%.6g, %.6g, %.6g)", at.x, at.y, at.z);
  return text;
}

/// Throws Error if the mesh is not closed, so that the parity of crossings has no meaning.
void check_closed(const QuantizedMesh& mesh, const Grid& grid, MemoryBudget* memory,
                  Progress* progress) {
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

/// Returns the DAG of all voxels of a grid, or of none.
Svdag whole_grid(int levels, bool is_full, MemoryBudget* memory, Progress* progress) {
  if (is_full) return rewrite(FullGrid(), levels, memory, progress);
  Svdag empty;
  empty.levels = levels;
  return empty;
}

Svdag fill_by_parity(const SvdagView& cover, const QuantizedMesh& mesh, MemoryBudget* memory,
                     Progress* progress) {
  if (cover.is_empty())
    return whole_grid(cover.levels, are_inside(mesh, {Vec3i{}}, progress).front(), memory,
                      progress);
  const EmptyRegions regions(cover, memory, progress);
  return regions.fill(are_inside(mesh, regions.places(), progress));
}

/// Returns the voxels among `codes` that are outside, in the same order.
PageVector<std::uint64_t> select_outside(const PageVector<std::uint64_t>& codes,
                                         const WindingField& field, MemoryBudget* memory,
                                         Progress* progress) {
  // Near voxels at a time, so that most triangles have none behind them.
  constexpr std::size_t kBatch = std::size_t{1} << 20;
  PageVector<std::uint64_t> outside(memory);
  CountedVector<Vec3i> voxels(memory);
  for (std::size_t begin = 0; begin < codes.size(); begin += kBatch) {
    voxels.clear();
    for (std::size_t i = begin; i < std::min(codes.size(), begin + kBatch); ++i)
      voxels.push_back(morton_decode(codes[i]));
    const std::vector<bool> inside = field.are_inside(voxels, memory, progress);
    for (std::size_t i = 0; i < voxels.size(); ++i)
      if (!inside[i]) outside.push_back(codes[begin + i]);
  }
  return outside;
}

Svdag fill_by_winding(const SvdagView& cover, const QuantizedMesh& mesh, double threshold,
                      MemoryBudget* memory, Progress* progress) {
  const WindingField field(mesh, threshold, memory, progress);
  const PageVector<std::uint64_t> sheets = find_sheets(field, cover, memory, progress);
  if (sheets.empty()) {
    if (cover.is_empty())
      return whole_grid(cover.levels,
                        field.are_inside(std::vector{Vec3i{}}, memory, progress).front(), memory,
                        progress);
    const EmptyRegions regions(cover, memory, progress);
    return regions.fill(field.are_inside(regions.places(), memory, progress));
  }
  // Surface and sheets part the grid; then the voxels of the sheets that are outside go.
  const Svdag sheet_voxels = svdag_of_sorted(cover.levels, {sheets.data(), sheets.size()}, memory);
  const Svdag walls = combine(cover, sheet_voxels.view(), SetOperation::kUnion, memory, progress);
  const EmptyRegions regions(walls.view(), memory, progress);
  const Svdag filled = regions.fill(field.are_inside(regions.places(), memory, progress));
  const PageVector<std::uint64_t> outside = select_outside(sheets, field, memory, progress);
  const Svdag outside_voxels =
      svdag_of_sorted(cover.levels, {outside.data(), outside.size()}, memory);
  return combine(filled.view(), outside_voxels.view(), SetOperation::kDifference, memory, progress);
}

}  // namespace

Svdag fill_solid(const SvdagView& cover, const Mesh& mesh, const Grid& grid,
                 const SolidOptions& options, MemoryBudget* memory, Progress* progress) {
  if (options.rule == SolidRule::kFlood) return fill_cavities(cover, memory, progress);
  const QuantizedMesh quantized(mesh, grid, memory, progress);
  if (quantized.triangle_count() != quantized.mesh_triangle_count())
    throw Error("", "", "the mesh reaches too far out of the grid to tell what is inside");
  if (options.rule == SolidRule::kWinding)
    return fill_by_winding(cover, quantized, options.winding_threshold, memory, progress);
  check_closed(quantized, grid, memory, progress);
  return fill_by_parity(cover, quantized, memory, progress);
}

}  // namespace voxdag
