#pragma once
/// The upper levels of an ESVO under construction: cells with too much surface for one task.
#include <cstdint>
#include <vector>

#include "voxdag/builders/esvo/build/built_voxel.hpp"
#include "voxdag/builders/pieces/child_triangles.hpp"
#include "voxdag/builders/pieces/triangle_source.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

struct TopCell {
  static constexpr std::uint32_t kNoParent = ~std::uint32_t{0};

  int level = 0;
  Vec3i cell{};  ///< In cells of the level.
  std::uint32_t parent = kNoParent;
  int child = 0;           ///< Child index in the parent.
  TriangleList triangles;  ///< Triangles that may meet it. Empty unless a task.
  ConvexPolyhedron shape;  ///< Already cut by the cell's own contour.
  CellDecision decision;
  double weight = 0;              ///< See PieceStack::weight(); an estimate if `is_displaced`.
  bool is_displaced = false;      ///< Has displaced triangles; tasks with them are decided later.
  bool is_task = false;           ///< A task: its children are not among the cells.
  int children_left = 0;          ///< Children among the cells that are not finished.
  std::vector<BuiltVoxel> built;  ///< The finished children.
};

using TopCells = CountedVector<TopCell>;

/// The largest number of triangles that are loaded to decide a cell.
inline constexpr std::size_t kMaxLoaded = 1 << 14;

/// Decides the cells down to tasks, parents before children. The first cell is the root, which is
/// never a leaf. Small cells with displaced triangles are tasks; larger ones get contours around
/// volumes that enclose the triangles. Cells larger than 4³ voxels with more than `most_loaded`
/// triangles get the contours that they would get if they were loaded, but are never leaves and
/// never near the surface (CellDecision::is_near). Counts the cells and scratch memory in `work`.
/// Throws Cancelled and OverMemory.
TopCells find_top_cells(const TriangleSource& source, const EsvoSettings& settings,
                        const SurfaceShading* shading, Work work,
                        std::size_t most_loaded = kMaxLoaded);

/// Returns the tasks in Morton order.
std::vector<std::size_t> task_order(const TopCells& cells);

}  // namespace voxdag
