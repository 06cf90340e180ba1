#include "voxdag/builders/solid/fill_solid.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "voxdag/algebra/combine.hpp"
#include "voxdag/algebra/components.hpp"
#include "voxdag/algebra/empty_regions.hpp"
#include "voxdag/algebra/reorient.hpp"
#include "voxdag/algebra/rewrite.hpp"
#include "voxdag/algebra/shift.hpp"
#include "voxdag/algebra/voxels/morton_builder.hpp"
#include "voxdag/algebra/voxels/voxel_builder.hpp"
#include "voxdag/builders/dag/build_methods.hpp"
#include "voxdag/builders/solid/closed_mesh.hpp"
#include "voxdag/builders/solid/parity.hpp"
#include "voxdag/builders/solid/winding/winding_field.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/stored/svdag/for_each_voxel.hpp"

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
Svdag all_or_none(int levels, bool is_full, Work work) {
  if (is_full) return rewrite(FullGrid(), levels, work);
  Svdag empty;
  empty.levels = levels;
  return empty;
}

Svdag fill_by_parity(const SvdagView& cover, const QuantizedMesh& mesh, Work work) {
  if (cover.is_empty())
    return all_or_none(cover.levels, are_inside(mesh, {Vec3i{}}, work).front(), work);
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

Svdag fill_by_winding(const SvdagView& cover, const WindingField& field, Work work) {
  const PageVector<std::uint64_t> sheets = find_sheets(field, cover, work);
  if (sheets.empty()) {
    if (cover.is_empty())
      return all_or_none(cover.levels, field.are_inside(std::vector{Vec3i{}}, work).front(), work);
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

/// Returns whether a triangle with an area lies in a plane between voxels.
bool is_between_voxels(const QuantizedTriangle& t) {
  const auto is_in_plane = [&](int axis) {
    return t.x[axis] % kSubvoxels == 0 && t.x[axis] == t.y[axis] && t.x[axis] == t.z[axis];
  };
  return (is_in_plane(0) || is_in_plane(1) || is_in_plane(2)) &&
         cross(static_cast<Vec3l>(t.y) - static_cast<Vec3l>(t.x),
               static_cast<Vec3l>(t.z) - static_cast<Vec3l>(t.x)) != Vec3l{};
}

/// Returns the solid without the voxels that the body only touches with faces between voxels.
/// fill(cover) fills a cover.
///
/// The cover counts a cube's lower sides to the cube. A second solid, from a cover that counts the
/// upper sides instead, differs only in the voxels that the body touches. The function removes
/// those that have a voxel of both solids beside them; a sheet between voxels, which encloses
/// nothing, stays.
template <class Fill>
Svdag remove_touched(Svdag solid, const QuantizedMesh& mesh, const Fill& fill, Work work) {
  CountedVector<QuantizedTriangle> faces(work.memory), mirrored_mesh(work.memory);
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i)
    if (is_between_voxels(mesh.triangle(i))) faces.push_back(mesh.triangle(i));
  if (faces.empty()) return solid;
  mirrored_mesh.reserve(mesh.triangle_count());
  const std::int32_t side = kSubvoxels << solid.levels;
  for (std::size_t i = 0; i < mesh.triangle_count(); ++i) {
    QuantizedTriangle triangle = mesh.triangle(i);
    for (int corner = 0; corner < 3; ++corner) {
      triangle[corner] = Vec3i{side, side, side} - triangle[corner];
      for (int axis = 0; axis < 3; ++axis)
        if (triangle[corner][axis] > kMaxUnits)
          throw Error("", "", "the mesh reaches too far out of the grid to tell what is inside");
    }
    mirrored_mesh.push_back(triangle);
  }
  const int levels = solid.levels;
  const auto both = [&](const Svdag& a, const Svdag& b, SetOperation operation) {
    return combine(a.view(), b.view(), operation, work);
  };
  const Svdag mirrored_cover = build_range(std::move(mirrored_mesh), levels, {}, work);
  const Svdag cover =
      reorient(mirrored_cover.view(), then(then(mirrored(0), mirrored(1)), mirrored(2)), work);
  const Svdag body = both(solid, fill(cover.view()), SetOperation::kIntersection);
  const Svdag at_faces = build_range(std::move(faces), levels, {}, work);
  Svdag beside = body;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3i step{};
    step[axis] = 1;
    beside = both(beside, shift(beside.view(), step, levels, work), SetOperation::kUnion);
  }
  const Svdag touched =
      both(both(at_faces, body, SetOperation::kDifference), beside, SetOperation::kIntersection);
  return both(solid, touched, SetOperation::kDifference);
}

/// Returns the solid without the voxels of `cover` whose centres are outside. are_inside(voxels)
/// returns for each voxel whether its centre is inside.
template <class AreInside>
Svdag remove_outer_centres(const Svdag& solid, const SvdagView& cover, const AreInside& are_inside,
                           Work work) {
  constexpr std::size_t kBatch = std::size_t{1} << 20;
  MortonBuilder outside(cover.levels, work.memory);
  std::vector<Vec3i> voxels;
  const MemoryReservation batch(work.memory, kBatch * sizeof(Vec3i));
  const auto finish_batch = [&] {
    const std::vector<bool> inside = are_inside(voxels);
    for (std::size_t i = 0; i < voxels.size(); ++i)
      if (!inside[i]) outside.add(morton_encode(voxels[i]));
    voxels.clear();
  };
  for_each_voxel(cover, whole_grid(cover.levels), [&](Vec3i voxel) {
    voxels.push_back(voxel);
    if (voxels.size() == kBatch) finish_batch();
  });
  finish_batch();
  return combine(solid.view(), outside.finish().view(), SetOperation::kDifference, work);
}

}  // namespace

Svdag fill_solid(const SvdagView& cover, const Mesh& mesh, const Grid& grid,
                 const SolidOptions& options, Work work) {
  if (options.rule == SolidRule::kFlood) {
    if (options.by_centre) throw Error("", "", "flooding tells nothing about centres of voxels");
    return fill_cavities(cover, work);
  }
  const QuantizedMesh quantized(mesh, grid, work);
  if (quantized.triangle_count() != quantized.mesh_triangle_count())
    throw Error("", "", "the mesh reaches too far out of the grid to tell what is inside");
  std::optional<WindingField> field;
  if (options.rule == SolidRule::kWinding)
    field.emplace(quantized, options.winding_threshold, work);
  else
    check_closed(quantized, grid, work);
  const auto fill = [&](const SvdagView& of) {
    return field ? fill_by_winding(of, *field, work) : fill_by_parity(of, quantized, work);
  };
  Svdag solid = fill(cover);
  if (!options.by_centre) return remove_touched(std::move(solid), quantized, fill, work);
  const auto inside = [&](const std::vector<Vec3i>& voxels) {
    return field ? field->are_inside(voxels, work) : are_inside(quantized, voxels, work);
  };
  return remove_outer_centres(solid, cover, inside, work);
}

}  // namespace voxdag
