#include "voxdag/esvo/top_cells.hpp"

#include <tbb/enumerable_thread_specific.h>

#include "voxdag/parallel/parallel_for.hpp"

namespace voxdag {
namespace {

/// Voxels of surface that one task takes.
constexpr double kTaskWeight = 1 << 16;

}  // namespace

void load(CellBuilder& builder, const TriangleSource& source, const TopCell& cell, int levels) {
  const int log2_size = levels - cell.level;
  const Vec3i origin = cell.cell * (1 << log2_size);
  builder.start(log2_size, cell.shape);
  for (const std::uint32_t triangle : cell.triangles)
    builder.add(SurfaceTriangle::make(source.mesh.triangle(triangle), origin,
                                      source.mesh.source(triangle), source.open_edges[triangle]),
                triangle);
}

std::vector<TopCell> find_top_cells(const TriangleSource& source, int levels,
                                    const EsvoSettings& settings, const SurfaceShading* shading,
                                    Progress* progress) {
  std::vector<TopCell> cells(1);
  cells[0].shape = ConvexPolyhedron::cube();
  for (std::size_t i = 0; i < source.mesh.triangle_count(); ++i)
    if (source.mesh.in_range(i)) cells[0].triangles.push_back(static_cast<std::uint32_t>(i));

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
      CellBuilder& builder = builders.local();
      load(builder, source, cell, levels);
      cell.weight = builder.weight();
      if (cell.parent != TopCell::kNoParent) {
        cell.decision = builder.decide();
        cell.shape = builder.shape();
      }
      cell.is_task = cell.decision.is_leaf || levels - cell.level <= 2 || cell.weight < kTaskWeight;
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
