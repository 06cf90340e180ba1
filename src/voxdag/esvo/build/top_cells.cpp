#include "voxdag/esvo/build/top_cells.hpp"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "voxdag/esvo/build/enclose_cell.hpp"
#include "voxdag/parallel/parallel_for.hpp"
#include "voxdag/voxelize/overlap.hpp"

namespace voxdag {
namespace {

/// Voxels of surface that one task takes.
constexpr double kTaskWeight = 1 << 16;

/// The side of the smallest cells that are still divided into tasks.
constexpr int kLeastLog2 = 2;

/// Cells of more triangles have no contours: they are not worth the memory that it takes to look at
/// all of the triangles at once.
constexpr std::size_t kMostLoaded = 1 << 14;

/// The side of the cells in which displaced triangles are tessellated.
constexpr int kDisplacedTaskLog2 = 4;

void add_displaced(CellBuilder& builder, const TriangleSource& source, const TopCell& cell,
                   std::uint32_t triangle) {
  const Grid& grid = source.grid;
  const int log2_size = grid.levels - cell.level;
  const Vec3i origin = cell.cell * (1 << log2_size);
  const std::int64_t side = std::int64_t{kSubvoxels} << log2_size;
  const Vec3l lo = static_cast<Vec3l>(origin) * std::int64_t{kSubvoxels};
  const Vec3l hi = lo + Vec3l{side, side, side};
  // Most lie in the cell as a whole: the exact test is slow.
  const auto meets_cell = [&](const QuantizedTriangle& t) {
    const auto least = static_cast<Vec3l>(min(t.x, min(t.y, t.z)));
    const auto most = static_cast<Vec3l>(max(t.x, max(t.y, t.z)));
    bool is_inside = true, is_outside = false;
    for (int axis = 0; axis < 3; ++axis) {
      is_inside &= least[axis] >= lo[axis] && most[axis] < hi[axis];
      is_outside |= most[axis] < lo[axis] || least[axis] >= hi[axis];
    }
    return is_inside || (!is_outside && triangle_overlaps_cube(t.x, t.y, t.z, lo, side));
  };
  source.displaced->tessellate(
      triangle, world_box(grid, cell.cell, log2_size), source.edge_limit(),
      [&](const MicroTriangle& micro) {
        QuantizedTriangle quantized;
        for (int i = 0; i < 3; ++i) {
          const std::optional<Vec3i> q =
              quantize(grid, micro.positions[static_cast<std::size_t>(i)]);
          if (!q) return;
          quantized[i] = *q;
        }
        if (!meets_cell(quantized)) return;
        const Vec2f barycentrics[3] = {micro.barycentrics[0], micro.barycentrics[1],
                                       micro.barycentrics[2]};
        builder.add(SurfaceTriangle::make_displaced(quantized, origin, triangle, barycentrics),
                    triangle);
      });
}

using Children = std::array<std::vector<std::uint32_t>, 8>;

/// Which children of a cell its triangles may meet, without a CellBuilder: for cells that get no
/// contour.
class CellSplitter {
 public:
  CellSplitter(const TriangleSource& source, const TopCell& cell)
      : source_(source),
        log2_half_(source.grid.levels - cell.level - 1),
        origin_(cell.cell * (2 << log2_half_)) {
    for (int child = 0; child < 8; ++child)
      regions_[static_cast<std::size_t>(child)] = world_box(
          source.grid, cell.cell * 2 + Vec3i{child & 1, child >> 1 & 1, child >> 2}, log2_half_);
  }

  Children split(const std::vector<std::uint32_t>& triangles) const {
    constexpr std::size_t kChunk = 1024;
    std::vector<Children> chunks((triangles.size() + kChunk - 1) / kChunk);
    parallel_for(chunks.size(), [&](std::size_t chunk) {
      const std::size_t end = std::min((chunk + 1) * kChunk, triangles.size());
      for (std::size_t i = chunk * kChunk; i < end; ++i)
        for (std::uint32_t left = children_met(triangles[i]); left != 0; left &= left - 1)
          chunks[chunk][static_cast<std::size_t>(std::countr_zero(left))].push_back(triangles[i]);
    });
    Children children;
    for (std::size_t child = 0; child < 8; ++child)
      for (const Children& chunk : chunks)
        children[child].insert(children[child].end(), chunk[child].begin(), chunk[child].end());
    return children;
  }

 private:
  /// A mask.
  std::uint32_t children_met(std::uint32_t triangle) const {
    if (source_.is_displaced(triangle)) {
      return source_.displaced->regions_met(triangle, regions_, source_.edge_limit(),
                                            std::ldexp(source_.grid.voxel_size, log2_half_ - 2));
    }
    const TriangleSetup setup = make_triangle_setup(source_.mesh.triangle(triangle), origin_);
    return classify_children(setup, setup.conditions, {}, 1 << log2_half_).alive;
  }

  const TriangleSource& source_;
  int log2_half_;
  Vec3i origin_;
  std::array<Box3d, 8> regions_;
};

/// What classify_children() takes for granted: that the triangle's box meets the cell's.
bool box_meets_grid(const QuantizedTriangle& t, const Grid& grid) {
  const std::int64_t side = grid.resolution() * kSubvoxels;
  const Vec3i lo = min(t.x, min(t.y, t.z)), hi = max(t.x, max(t.y, t.z));
  for (int axis = 0; axis < 3; ++axis)
    if (hi[axis] < 0 || lo[axis] >= side) return false;
  return true;
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
    if (is_displaced
            ? !is_piece
            : source.mesh.in_range(i) && box_meets_grid(source.mesh.triangle(i), source.grid))
      cells[0].triangles.push_back(static_cast<std::uint32_t>(i));
  }

  tbb::enumerable_thread_specific<CellBuilder> builders(
      [&] { return CellBuilder(settings, shading); });
  for (std::size_t begin = 0; begin < cells.size();) {
    const std::size_t end = cells.size();
    std::vector<Children> children(end - begin);
    parallel_for(end - begin, [&](std::size_t i) {
      if (progress != nullptr && progress->cancelled()) return;
      TopCell& cell = cells[begin + i];
      const int log2_size = source.grid.levels - cell.level;
      cell.is_displaced =
          std::any_of(cell.triangles.begin(), cell.triangles.end(),
                      [&](std::uint32_t triangle) { return source.is_displaced(triangle); });
      const bool is_heavy = cell.triangles.size() > kMostLoaded && log2_size > kLeastLog2;
      if (cell.is_displaced || is_heavy) {
        cell.weight = std::ldexp(1.0, 2 * log2_size);
        cell.is_task = cell.is_displaced && log2_size <= kDisplacedTaskLog2;
        if (cell.is_task) return;
        if (settings.contours && !is_heavy && cell.parent != TopCell::kNoParent)
          cell.decision =
              decide_enclosed(source, cell.level, cell.cell, cell.triangles, cell.shape);
        children[i] = CellSplitter(source, cell).split(cell.triangles);
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
      cell.is_task = cell.decision.is_leaf || log2_size <= kLeastLog2 || cell.weight < kTaskWeight;
      if (cell.is_task) return;
      builder.split(children[i]);
      cell.triangles = {};
    });
    if (progress != nullptr) progress->throw_if_cancelled();
    for (std::size_t at = begin; at < end; ++at) {
      if (cells[at].is_task) continue;
      for (int child = 0; child < 8; ++child) {
        std::vector<std::uint32_t>& triangles =
            children[at - begin][static_cast<std::size_t>(child)];
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
      // What may meet a cell need not: a task without triangles says so to the cell above.
      if (cells[at].children_left == 0) cells[at].is_task = true;
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
