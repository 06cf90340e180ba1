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
void check_closed(const QuantizedMesh& mesh, const Grid& grid, Work work) {
  const OddEdges odd = find_odd_edges(mesh, work);
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
Svdag whole_grid(int levels, bool is_full, Work work) {
  if (is_full) return rewrite(FullGrid(), levels, work);
  Svdag empty;
  empty.levels = levels;
  return empty;
}

Svdag fill_by_parity(const SvdagView& cover, const QuantizedMesh& mesh, Work work) {
  if (cover.is_empty())
    return whole_grid(cover.levels, are_inside(mesh, {Vec3i{}}, work).front(), work);
  const EmptyRegions regions(cover, work);
  return regions.fill(are_inside(mesh, regions.places(), work));
}

/// Returns the voxels among `codes` that are outside, in the same order.
PageVector<std::uint64_t> select_outside(const PageVector<std::uint64_t>& codes,
                                         const WindingField& field, Work work) {
  // Near voxels at a time, so that most triangles have none behind them.
  constexpr std::size_t kBatch = std::size_t{1} << 20;
  PageVector<std::uint64_t> outside(work.memory);
  CountedVector<Vec3i> voxels(work.memory);
  for (std::size_t begin = 0; begin < codes.size(); begin += kBatch) {
    voxels.clear();
    for (std::size_t i = begin; i < std::min(codes.size(), begin + kBatch); ++i)
      voxels.push_back(morton_decode(codes[i]));
    const std::vector<bool> inside = field.are_inside(voxels, work);
    for (std::size_t i = 0; i < voxels.size(); ++i)
      if (!inside[i]) outside.push_back(codes[begin + i]);
  }
  return outside;
}

Svdag fill_by_winding(const SvdagView& cover, const QuantizedMesh& mesh, double threshold,
                      Work work) {
  const WindingField field(mesh, threshold, work);
  const PageVector<std::uint64_t> sheets = find_sheets(field, cover, work);
  if (sheets.empty()) {
    if (cover.is_empty())
      return whole_grid(cover.levels, field.are_inside(std::vector{Vec3i{}}, work).front(), work);
    const EmptyRegions regions(cover, work);
    return regions.fill(field.are_inside(regions.places(), work));
  }
  // Surface and sheets part the grid; then the voxels of the sheets that are outside go.
  const Svdag sheet_voxels =
      svdag_of_sorted(cover.levels, {sheets.data(), sheets.size()}, work.memory);
  const Svdag walls = combine(cover, sheet_voxels.view(), SetOperation::kUnion, work);
  const EmptyRegions regions(walls.view(), work);
  const Svdag filled = regions.fill(field.are_inside(regions.places(), work));
  const PageVector<std::uint64_t> outside = select_outside(sheets, field, work);
  const Svdag outside_voxels =
      svdag_of_sorted(cover.levels, {outside.data(), outside.size()}, work.memory);
  return combine(filled.view(), outside_voxels.view(), SetOperation::kDifference, work);
}

}  // namespace

Svdag fill_solid(const SvdagView& cover, const Mesh& mesh, const Grid& grid,
                 const SolidOptions& options, Work work) {
  if (options.rule == SolidRule::kFlood) return fill_cavities(cover, work);
  const QuantizedMesh quantized(mesh, grid, work);
  if (quantized.triangle_count() != quantized.mesh_triangle_count())
    throw Error("", "", "the mesh reaches too far out of the grid to tell what is inside");
  if (options.rule == SolidRule::kWinding)
    return fill_by_winding(cover, quantized, options.winding_threshold, work);
  check_closed(quantized, grid, work);
  return fill_by_parity(cover, quantized, work);
}

}  // namespace voxdag
