#pragma once
/// The upper levels of an ESVO in the making: cells with too much surface for one task.
#include <cstdint>
#include <vector>

#include "voxdag/esvo/build/cell_builder.hpp"
#include "voxdag/esvo/build/triangle_source.hpp"
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

struct TopCell {
  static constexpr std::uint32_t kNoParent = ~std::uint32_t{0};

  int level = 0;
  Vec3i cell{};  ///< In cells of the level.
  std::uint32_t parent = kNoParent;
  int child = 0;                         ///< Which of the parent's children it is.
  std::vector<std::uint32_t> triangles;  ///< Those that may meet it, if it is a task.
  ConvexPolyhedron shape;                ///< Cut by its own contour, too.
  VoxelDecision decision;
  double weight = 0;              ///< CellBuilder::weight.
  bool is_displaced = false;      ///< Has displaced triangles: a task is decided when it is built.
  bool is_task = false;           ///< Its children are not among the cells.
  int children_left = 0;          ///< Children that are cells and not finished.
  std::vector<BuiltVoxel> built;  ///< The children that are finished.
};

/// Decides the cells down to tasks, parents before children. The first is the root, which is no
/// leaf. Cells with displaced triangles become tasks when they are small; above that they get
/// contours around what encloses the triangles. Cells of very many triangles get none. Throws
/// Cancelled.
std::vector<TopCell> find_top_cells(const TriangleSource& source, const EsvoSettings& settings,
                                    const SurfaceShading* shading, Progress* progress);

/// The tasks in Morton order.
std::vector<std::size_t> task_order(const std::vector<TopCell>& cells);

/// Starts the cell with its triangles; displaced ones are tessellated to the size of a voxel.
void load(CellBuilder& builder, const TriangleSource& source, const TopCell& cell);

}  // namespace voxdag
