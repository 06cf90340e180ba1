#include "voxdag/builders/pieces/split_triangles.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <vector>

#include "voxdag/builders/voxelize/cell_classify.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/core/parallel/parallel_for.hpp"

namespace voxdag {
namespace {

/// Returns whether the triangle's box meets the grid, as classify_children() requires.
bool box_meets_grid(const QuantizedTriangle& t, const Grid& grid) {
  const std::int64_t side = grid.resolution() * kSubvoxels;
  const Vec3i lo = min(t.x, min(t.y, t.z)), hi = max(t.x, max(t.y, t.z));
  for (int axis = 0; axis < 3; ++axis)
    if (hi[axis] < 0 || lo[axis] >= side) return false;
  return true;
}

class Splitter {
 public:
  Splitter(const TriangleSource& source, int level, Vec3i cell)
      : source_(source),
        log2_half_(source.grid.levels - level - 1),
        origin_(cell * (2 << log2_half_)) {
    for (int child = 0; child < 8; ++child)
      regions_[static_cast<std::size_t>(child)] =
          world_box(source.grid, cell * 2 + child_offset(child), log2_half_);
  }

  /// Returns a bit mask of the children that a triangle may meet.
  std::uint32_t children_met(std::uint32_t triangle) const {
    if (source_.is_displaced(triangle)) {
      return source_.displaced->regions_met(triangle, regions_, source_.edge_limit(),
                                            std::ldexp(source_.grid.voxel_size, log2_half_ - 2));
    }
    const TriangleSetup setup = make_triangle_setup(source_.mesh.triangle(triangle), origin_);
    return classify_children(setup, setup.conditions, {}, 1 << log2_half_).alive;
  }

 private:
  const TriangleSource& source_;
  int log2_half_;
  Vec3i origin_;
  std::array<Box3d, 8> regions_;
};

}  // namespace

TriangleList triangles_of_grid(const TriangleSource& source, MemoryBudget* memory) {
  TriangleList triangles(memory);
  triangles.reserve(source.mesh.triangle_count());
  for (std::size_t i = 0; i < source.mesh.triangle_count(); ++i) {
    if (source.is_duplicate(i)) continue;
    // Displaced triangles are clipped after displacement. So the triangles themselves are listed,
    // not the pieces from clipping.
    const bool is_piece = i >= source.mesh.mesh_triangle_count();
    const bool is_displaced = source.is_displaced(source.mesh.source(i));
    if (is_displaced
            ? !is_piece
            : source.mesh.in_range(i) && box_meets_grid(source.mesh.triangle(i), source.grid))
      triangles.push_back(static_cast<std::uint32_t>(i));
  }
  return triangles;
}

ChildTriangles split_triangles(const TriangleSource& source, int level, Vec3i cell,
                               std::span<const std::uint32_t> triangles, MemoryBudget* memory) {
  constexpr std::size_t kChunk = 1024;
  const Splitter splitter(source, level, cell);
  std::vector<ChildTriangles> chunks((triangles.size() + kChunk - 1) / kChunk,
                                     empty_children(memory));
  parallel_for(chunks.size(), [&](std::size_t chunk) {
    const std::size_t end = std::min((chunk + 1) * kChunk, triangles.size());
    for (std::size_t i = chunk * kChunk; i < end; ++i)
      for (std::uint32_t left = splitter.children_met(triangles[i]); left != 0; left &= left - 1)
        chunks[chunk][static_cast<std::size_t>(std::countr_zero(left))].push_back(triangles[i]);
  });
  ChildTriangles children = empty_children(memory);
  for (std::size_t child = 0; child < 8; ++child) {
    std::size_t count = 0;
    for (const ChildTriangles& chunk : chunks) count += chunk[child].size();
    children[child].reserve(count);
    for (ChildTriangles& chunk : chunks) {
      children[child].insert(children[child].end(), chunk[child].begin(), chunk[child].end());
      chunk[child] = TriangleList(memory);
    }
  }
  return children;
}

}  // namespace voxdag
