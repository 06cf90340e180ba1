#include "voxdag/builders/attributes/filter_materials.hpp"

#include <algorithm>
#include <numeric>

#include "voxdag/builders/attributes/filter_tasks.hpp"
#include "voxdag/builders/attributes/material_cells.hpp"
#include "voxdag/core/parallel/per_thread.hpp"
#include "voxdag/stored/attributes/encode_material_ids.hpp"

namespace voxdag {
namespace {

struct TaskResult {
  MaterialAreas areas;
  std::vector<CellRun> runs;
};

/// The materials of a top cell.
struct TopMaterials {
  MaterialAreas areas;   ///< Empty once the areas of its parent include them.
  std::uint32_t id = 0;  ///< The cell's own material.
  /// For a task: the runs of all cells in its subtree. Both 0 for other cells.
  std::size_t first_run = 0, end_run = 0;
};

/// Adds the areas of the children to those of the top cells, and finds the top cells' materials.
void join_top_cells(const NumberedTopCells& cells, std::vector<TopMaterials>& of) {
  // Children follow their parents in `cells`.
  for (std::size_t i = cells.size(); i-- > 0;) {
    for (std::size_t k = 0; k < cells[i].child_count; ++k) {
      add_areas(of[i].areas, of[cells[i].first_child + k].areas);
      of[cells[i].first_child + k].areas = {};
    }
    if (!of[i].areas.empty()) of[i].id = largest_material(of[i].areas);
  }
}

}  // namespace

MaterialIds filter_materials(const Mesh& mesh, const Grid& grid, const SvdagView& dag,
                             const CellIndexView& index, Work work, const TriangleIds& ids) {
  if (dag.is_empty()) return {};
  const std::span<const std::uint32_t> of_triangles =
      ids.count > 0 ? ids.ids : std::span<const std::uint32_t>(mesh.triangle_materials);
  const std::uint32_t count =
      ids.count > 0 ? ids.count : static_cast<std::uint32_t>(mesh.materials.size());
  const QuantizedMesh quantized(mesh, grid, work);
  const MemoryReservation tables(work.memory, quantized.triangle_count());
  const IndexSet no_duplicates;
  const std::vector<std::uint8_t> no_open_edges(quantized.triangle_count());
  const TriangleSource source{grid, quantized, no_open_edges, nullptr, no_duplicates};
  NumberedTopCells cells = list_top_cells(dag, index, source, work);
  std::vector<TopMaterials> of(cells.size());
  CountedVector<CellRun> runs(work.memory);
  PerThread<MaterialFilter> filters(
      [&] { return MaterialFilter(dag, index, source, of_triangles, work.memory); });
  filter_tasks(
      dag, index, cells, MaterialFilter::kBytesPerCell, work, "materials",
      [&](const CellTask& task) {
        TaskResult result;
        result.areas = filters.local().filter(task, result.runs);
        result.runs.shrink_to_fit();
        return result;
      },
      [&](std::size_t i, TaskResult& result) {
        of[i].areas = std::move(result.areas);
        of[i].first_run = runs.size();
        runs.insert(runs.end(), result.runs.begin(), result.runs.end());
        of[i].end_run = runs.size();
      });
  join_top_cells(cells, of);

  std::vector<std::size_t> order(cells.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return cells[a].cell.number < cells[b].cell.number;
  });
  MaterialEncoder encoder(count, work.memory);
  for (const std::size_t i : order) {
    if (!cells[i].is_task) encoder.add(of[i].id, 1);
    for (std::size_t run = of[i].first_run; run < of[i].end_run; ++run)
      encoder.add(runs[run].id, runs[run].length);
  }
  return encoder.finish();
}

}  // namespace voxdag
