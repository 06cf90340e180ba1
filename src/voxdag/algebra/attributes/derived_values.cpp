#include "voxdag/algebra/attributes/derived_values.hpp"

#include <algorithm>
#include <bit>

#include "voxdag/stored/attributes/build_cell_index.hpp"

namespace voxdag::detail {

FinestCells::FinestCells(const SvdagView& dag, const CellIndexView& index, MemoryBudget* memory)
    : dag_(dag),
      index_(index),
      above_(build_cell_index(dag, std::max(index.finest_level - 1, 0), memory)),
      bytes_(memory, above_.view().bytes()) {}

std::uint64_t voxels_in(const SvdagView& dag, const NumberedCell& cell) {
  if (cell.level == dag.levels) return 1;
  if (cell.level == dag.levels - 1) return static_cast<std::uint64_t>(popcount8(cell.octant));
  if (cell.level == dag.levels - 2)
    return static_cast<std::uint64_t>(popcount64(dag.leaf_blocks[cell.at]));
  std::uint64_t voxels = 0;
  for (std::uint32_t left = children_of(dag, cell); left != 0; left &= left - 1) {
    NumberedCell child;
    child.level = cell.level + 1;
    child.at = child_pointer(dag.nodes + cell.at, std::countr_zero(left));
    voxels += voxels_in(dag, child);
  }
  return voxels;
}

DerivedValues::DerivedValues(const SvdagView& dag, int finest_level, const ValueKinds& kinds,
                             const CoarsenBounds& bounds, Work work)
    : dag_(dag),
      kinds_(kinds),
      work_(work),
      result_{build_cell_index(dag, finest_level, work.memory), {}, {}, {}, {}, {}},
      index_bytes_(work.memory, result_.index.view().bytes()),
      index_(result_.index.view()),
      finest_(dag, index_, work.memory),
      colors_(kinds.colors ? index_.cells : 0,
              make_value_metric(kColorWeights, 255 * bounds.color_bound), work.memory),
      normals_(kinds.normals ? index_.cells : 0, make_normal_metric(bounds.normal_bound_degrees),
               work.memory),
      tops_(work.memory),
      materials_(work.memory) {}

void DerivedValues::encode(std::uint64_t first, ValueList& values) {
  colors_.add(first, values.colors);
  normals_.add(first, values.normals);
  values.colors = values.normals = {};
}

std::vector<MaterialCells> DerivedValues::runs_of(const std::vector<std::uint16_t>& materials) {
  std::vector<MaterialCells> runs;
  for (const std::uint16_t id : materials) {
    if (runs.empty() || runs.back().id != id) runs.push_back({id, 0});
    ++runs.back().count;
  }
  return runs;
}

void DerivedValues::add_materials(TopCell& top, const std::vector<MaterialCells>& runs) {
  if (top.first_materials == top.end_materials) top.first_materials = materials_.size();
  materials_.insert(materials_.end(), runs.begin(), runs.end());
  top.end_materials = materials_.size();
}

/// Returns the values of the cell tops_[at]. Sets those of the inner cells in its subtree, and `at`
/// to the place of the next cell.
CellValues DerivedValues::join(std::size_t& at) {
  TopCell& top = tops_[at++];
  if (!top.is_inner) return top.values;
  CellMean mean(kinds_);
  for (int left = popcount(children_of(dag_, top.cell)); left > 0; --left) {
    const std::uint64_t weight = finest_.below(tops_[at].cell);
    mean.add(join(at), weight);
  }
  top.values = mean.result();
  ValueList one;
  one.push(kinds_, top.values);
  encode(top.cell.number, one);
  return top.values;
}

DagAttributes DerivedValues::finish() {
  std::size_t at = 0;
  join(at);
  if (kinds_.colors) result_.colors = colors_.finish(), result_.color_errors = colors_.errors();
  const MemoryReservation color_bytes(work_.memory, result_.colors.view().bytes());
  if (kinds_.normals)
    result_.normals = normals_.finish(), result_.normal_errors = normals_.errors();
  const MemoryReservation normal_bytes(work_.memory, result_.normals.view().bytes());
  if (kinds_.materials == 0) return std::move(result_);
  MaterialEncoder encoder(kinds_.materials, work_.memory);
  for (const TopCell& top : tops_) {
    if (top.is_inner) encoder.add(top.values.material, 1);
    for (std::uint64_t i = top.first_materials; i < top.end_materials; ++i)
      encoder.add(materials_[i].id, materials_[i].count);
  }
  result_.materials = encoder.finish();
  return std::move(result_);
}

}  // namespace voxdag::detail
