#include "voxdag/algebra/attributes/derived_values.hpp"

#include <algorithm>
#include <bit>

#include "voxdag/stored/attributes/build_cell_index.hpp"

namespace voxdag::detail {

namespace {

const ValuePagesView& colors_of(const DagAttributesView& of) { return of.colors; }
const ValuePagesView& normals_of(const DagAttributesView& of) { return of.normals; }

template <class Pages>
ValueEncoder make_encoder(std::uint64_t cells, const ValueMetric& metric, bool copies,
                          std::span<const StoredValues> stored, const Pages& pages, bool has_8_bits,
                          MemoryBudget* memory) {
  if (!copies) return {cells, metric, memory};
  if (has_8_bits) return {cells, metric, joined_precision({}), memory};
  std::vector<PagePrecision> precisions;
  for (const StoredValues& values : stored)
    if (!pages(values.attributes).is_empty())
      precisions.push_back(pages(values.attributes).precision);
  return {cells, metric, joined_precision(precisions), memory};
}

}  // namespace

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
                             std::vector<StoredValues> stored, const CoarsenBounds& bounds,
                             bool has_8_bits, Work work)
    : dag_(dag),
      kinds_(kinds),
      stored_(std::move(stored)),
      copies_colors_(bounds.color_bound <= 0),
      copies_normals_(bounds.normal_bound_degrees < kMinNormalBound),
      work_(work),
      result_{build_cell_index(dag, finest_level, work.memory), {}, {}, {}, {}, {}, {}},
      index_bytes_(work.memory, result_.index.view().bytes()),
      index_(result_.index.view()),
      finest_(dag, index_, work.memory),
      colors_(make_encoder(kinds.colors ? index_.cells : 0,
                           make_value_metric(kColorWeights, 255 * bounds.color_bound),
                           copies_colors_, stored_, colors_of, has_8_bits, work.memory)),
      normals_(make_encoder(kinds.normals ? index_.cells : 0,
                            make_normal_metric(bounds.normal_bound_degrees), copies_normals_,
                            stored_, normals_of, has_8_bits, work.memory)),
      tops_(work.memory),
      materials_(work.memory) {}

void DerivedValues::check_precision(const CellValues& values) {
  if ((copies_colors_ && kinds_.colors && !colors_.can_store(values.color)) ||
      (copies_normals_ && kinds_.normals && !normals_.can_store(values.normal)))
    needs_8_bits_ = true;
}

template <class Pages, class Value>
void DerivedValues::encode_kind(ValueEncoder& encoder, bool copies, std::uint64_t first,
                                const ValueList& list, const Pages& pages,
                                const Value& value) const {
  std::vector<Value8> values;
  std::size_t next = 0;
  for (const ValueList::Part& part : list.parts()) {
    values.clear();
    if (!part.run) {
      for (std::uint64_t i = 0; i < part.cells; ++i) values.push_back(value(list.values()[next++]));
      encoder.add(first, values);
    } else {
      const ValuePagesView& from = pages(stored_[part.run->stored].attributes);
      if (copies) {
        encoder.copy(first, part.cells, from, part.run->first);
      } else {
        PageReader reader(from);
        for (std::uint64_t i = 0; i < part.cells; ++i)
          values.push_back(reader.value(part.run->first + i));
        encoder.add(first, values);
      }
    }
    first += part.cells;
  }
}

void DerivedValues::encode(std::uint64_t first, const ValueList& list) {
  if (kinds_.colors)
    encode_kind(colors_, copies_colors_, first, list, colors_of,
                [](const CellValues& values) { return values.color; });
  if (kinds_.normals)
    encode_kind(normals_, copies_normals_, first, list, normals_of,
                [](const CellValues& values) { return values.normal; });
}

std::vector<MaterialCells> DerivedValues::materials_of(const ValueList& list) const {
  std::vector<MaterialCells> runs;
  if (kinds_.materials == 0) return runs;
  const auto add = [&](std::uint32_t id) {
    if (runs.empty() || runs.back().id != id) runs.push_back({id, 0});
    ++runs.back().count;
  };
  std::size_t next = 0;
  for (const ValueList::Part& part : list.parts()) {
    if (!part.run) {
      for (std::uint64_t i = 0; i < part.cells; ++i) add(list.values()[next++].material);
      continue;
    }
    StoredReader reader(stored_[part.run->stored]);
    for (std::uint64_t i = 0; i < part.cells; ++i) add(reader.material(part.run->first + i));
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
  one.push(top.values);
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
