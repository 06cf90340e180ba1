#include "voxdag/esvo/top_cells.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>

#include "voxdag/parallel/parallel_for.hpp"
#include "voxdag/voxelize/overlap.hpp"

namespace voxdag {
namespace {

/// Voxels of surface that one task takes.
constexpr double kTaskWeight = 1 << 16;

/// The side of the cells in which displaced triangles are tessellated.
constexpr int kDisplacedTaskLog2 = 7;

/// In world units, with a little more around for rounding.
Box3d world_box(const Grid& grid, Vec3i cell, int log2_size) {
  const double size = static_cast<double>(std::int64_t{1} << log2_size), margin = 1.0 / kSubvoxels;
  const Vec3d lo = static_cast<Vec3d>(cell) * size;
  return {grid.to_world(lo - Vec3d{margin, margin, margin}),
          grid.to_world(lo + Vec3d{size + margin, size + margin, size + margin})};
}

void add_displaced(CellBuilder& builder, const TriangleSource& source, const TopCell& cell,
                   std::uint32_t triangle) {
  const Grid& grid = source.grid;
  const int log2_size = grid.levels - cell.level;
  const Vec3i origin = cell.cell * (1 << log2_size);
  const Vec3l lo = static_cast<Vec3l>(origin) * std::int64_t{kSubvoxels};
  source.displaced->tessellate(
      triangle, world_box(grid, cell.cell, log2_size), grid.voxel_size,
      [&](const MicroTriangle& micro) {
        QuantizedTriangle quantized;
        for (int i = 0; i < 3; ++i) {
          const std::optional<Vec3i> q =
              quantize(grid, micro.positions[static_cast<std::size_t>(i)]);
          if (!q) return;
          quantized[i] = *q;
        }
        if (!triangle_overlaps_cube(quantized.x, quantized.y, quantized.z, lo,
                                    std::int64_t{kSubvoxels} << log2_size))
          return;
        const Vec2f barycentrics[3] = {micro.barycentrics[0], micro.barycentrics[1],
                                       micro.barycentrics[2]};
        builder.add(SurfaceTriangle::make_displaced(quantized, origin, triangle, barycentrics),
                    triangle);
      });
}

/// The triangles that may meet each child, for cells with displaced ones.
void split_displaced(const TriangleSource& source, const TopCell& cell,
                     std::vector<std::uint32_t> (&children)[8]) {
  const Grid& grid = source.grid;
  const int log2_half = grid.levels - cell.level - 1;
  const double small = grid.voxel_size * static_cast<double>(std::int64_t{1} << log2_half) / 4;
  for (int child = 0; child < 8; ++child) {
    const Vec3i at = cell.cell * 2 + Vec3i{child & 1, child >> 1 & 1, child >> 2};
    const Box3d box = world_box(grid, at, log2_half);
    const Vec3l lo = static_cast<Vec3l>(at) * (std::int64_t{kSubvoxels} << log2_half);
    for (const std::uint32_t triangle : cell.triangles) {
      const QuantizedTriangle t = source.mesh.triangle(triangle);
      if (source.is_displaced(triangle)
              ? source.displaced->may_meet(triangle, box, grid.voxel_size, small)
              : triangle_overlaps_cube(t.x, t.y, t.z, lo, std::int64_t{kSubvoxels} << log2_half))
        children[child].push_back(triangle);
    }
  }
}

}  // namespace

void load(CellBuilder& builder, const TriangleSource& source, const TopCell& cell) {
  const int log2_size = source.grid.levels - cell.level;
  const Vec3i origin = cell.cell * (1 << log2_size);
  builder.start(log2_size, origin, cell.shape);
  for (const std::uint32_t triangle : cell.triangles)
    if (source.is_displaced(triangle))
      add_displaced(builder, source, cell, triangle);
    else
      builder.add(SurfaceTriangle::make(source.mesh.triangle(triangle), origin,
                                        source.mesh.source(triangle), source.open_edges[triangle]),
                  triangle);
}

std::vector<TopCell> find_top_cells(const TriangleSource& source, const EsvoSettings& settings,
                                    const SurfaceShading* shading, Progress* progress) {
  std::vector<TopCell> cells(1);
  cells[0].shape = ConvexPolyhedron::cube();
  for (std::size_t i = 0; i < source.mesh.triangle_count(); ++i) {
    // What is displaced is clipped after that, not before.
    const bool is_piece = i >= source.mesh.mesh_triangle_count();
    const bool is_displaced = source.is_displaced(source.mesh.source(i));
    if (is_displaced ? !is_piece : source.mesh.in_range(i))
      cells[0].triangles.push_back(static_cast<std::uint32_t>(i));
  }

  tbb::enumerable_thread_specific<CellBuilder> builders(
      [&] { return CellBuilder(settings, shading); });
  struct Children {
    std::vector<std::uint32_t> triangles[8];
  };
  for (std::size_t begin = 0; begin < cells.size();) {
    const std::size_t end = cells.size();
    std::vector<Children> children(end - begin);
    parallel_for(end - begin, [&](std::size_t i) {
      if (progress != nullptr && progress->cancelled()) return;
      TopCell& cell = cells[begin + i];
      const int log2_size = source.grid.levels - cell.level;
      if (std::any_of(cell.triangles.begin(), cell.triangles.end(),
                      [&](std::uint32_t triangle) { return source.is_displaced(triangle); })) {
        cell.weight = std::ldexp(1.0, 2 * log2_size);
        cell.is_task = log2_size <= kDisplacedTaskLog2;
        if (cell.is_task) return;
        split_displaced(source, cell, children[i].triangles);
        cell.triangles = {};
        return;
      }
      CellBuilder& builder = builders.local();
      load(builder, source, cell);
      cell.weight = builder.weight();
      if (cell.parent != TopCell::kNoParent) {
        cell.decision = builder.decide(cells[cell.parent].decision);
        cell.shape = builder.shape();
      }
      cell.is_task = cell.decision.is_leaf || log2_size <= 2 || cell.weight < kTaskWeight;
      if (cell.is_task) return;
      builder.split(children[i].triangles);
      cell.triangles = {};
    });
    if (progress != nullptr) progress->throw_if_cancelled();
    for (std::size_t at = begin; at < end; ++at) {
      if (cells[at].is_task) continue;
      for (int child = 0; child < 8; ++child) {
        std::vector<std::uint32_t>& triangles = children[at - begin].triangles[child];
        if (triangles.empty()) continue;
        ++cells[at].children_left;
        TopCell& cell = cells.emplace_back();
        cell.level = cells[at].level + 1;
        cell.cell = cells[at].cell * 2 + Vec3i{child & 1, child >> 1 & 1, child >> 2};
        cell.parent = static_cast<std::uint32_t>(at);
        cell.child = child;
        cell.triangles = std::move(triangles);
        cell.shape = cells[at].shape.octant(child);
      }
    }
    begin = end;
  }
  return cells;
}

std::vector<std::size_t> task_order(const std::vector<TopCell>& cells) {
  std::vector<std::vector<std::size_t>> children(cells.size());
  for (std::size_t i = 1; i < cells.size(); ++i) children[cells[i].parent].push_back(i);
  std::vector<std::size_t> tasks, stack{0};
  while (!stack.empty()) {
    const std::size_t at = stack.back();
    stack.pop_back();
    if (cells[at].is_task) tasks.push_back(at);
    stack.insert(stack.end(), children[at].rbegin(), children[at].rend());
  }
  return tasks;
}

}  // namespace voxdag
