#include "voxdag/algebra/attributes/placed_source.hpp"

#include <algorithm>
#include <cassert>

#include "voxdag/algebra/query/nearest_voxel.hpp"

namespace voxdag {
namespace {

bool is_turned(const AttributeLayer& layer) { return !(layer.orientation == Orientation{}); }

/// Returns the layer's voxel at a voxel of the result.
Vec3i layer_voxel(const AttributeLayer& layer, Vec3i voxel) {
  return source_cell(layer.orientation, voxel - layer.offset, layer.colored.dag.levels);
}

Value8 turned(Value8 normal, const Orientation& orientation) {
  Value8 result{};
  for (int axis = 0; axis < 3; ++axis) {
    const int value = normal[orientation.source_axis[axis]];
    result[axis] = static_cast<std::uint8_t>(
        orientation.is_flipped[axis] ? std::min(256 - value, 255) : value);
  }
  return result;
}

bool has_all(const ValueKinds& kinds, const ValueKinds& needed) {
  return kinds.colors >= needed.colors && kinds.normals >= needed.normals &&
         (kinds.materials != 0) >= (needed.materials != 0);
}

/// Returns the layer's child of a cell above its finest level.
PlacedSource::LayerCell child_in(const ColoredDagView& colored, const NumberedCell& cell,
                                 int child) {
  if ((children_of(colored.dag, cell) >> child & 1) == 0) return {PlacedSource::LayerCell::kAbsent};
  return {PlacedSource::LayerCell::kInStep,
          child_of(colored.dag, colored.attributes.index, cell, child)};
}

}  // namespace

PlacedSource::PlacedSource(const SvdagView& dag, int finest_level,
                           std::span<const AttributeLayer> layers, const NewValues& new_values,
                           const ValueKinds& kinds, MemoryBudget* memory)
    : dag_(dag),
      finest_(finest_level),
      layers_(layers),
      new_values_(new_values),
      kinds_(kinds),
      classes_(memory) {
  assert(layers.size() <= kMaxLayers);
  EqualNodes equal(memory);
  for (const AttributeLayer& layer : layers) {
    const SvdagView& layer_dag = layer.colored.dag;
    const DagAttributesView& attributes = layer.colored.attributes;
    const bool has_equal_cells =
        layer_dag.levels - attributes.index.finest_level == dag.levels - finest_level;
    has_runs_.push_back(has_equal_cells && !is_turned(layer) &&
                        has_all(kinds_of(attributes), kinds));
    layer_classes_.push_back(has_runs_.back() ? equal.add(layer_dag, attributes.index.finest_level)
                                              : NodeClasses(memory));
  }
  if (std::find(has_runs_.begin(), has_runs_.end(), true) != has_runs_.end())
    classes_ = equal.add(dag, finest_level);
}

PlacedSource::Cell PlacedSource::root() const {
  Cell cell;
  for (std::size_t i = 0; i < layers_.size(); ++i) cell[i] = find_cell(layers_[i], 0, {});
  return cell;
}

/// Looks the cell of the result up in a layer.
PlacedSource::LayerCell PlacedSource::find_cell(const AttributeLayer& layer, int level,
                                                Vec3i place) const {
  const SvdagView& dag = layer.colored.dag;
  const DagAttributesView& attributes = layer.colored.attributes;
  const int size = dag_.levels - level, layer_level = dag.levels - size;
  const std::int32_t rest = (std::int32_t{1} << size) - 1;
  if (is_turned(layer) || layer_level < 0 ||
      ((layer.offset.x | layer.offset.y | layer.offset.z) & rest) != 0)
    return {LayerCell::kUnknown};
  const Vec3i there{place.x - (layer.offset.x >> size), place.y - (layer.offset.y >> size),
                    place.z - (layer.offset.z >> size)};
  if ((there.x | there.y | there.z) >> layer_level != 0) return {LayerCell::kAbsent};
  LayerCell found{LayerCell::kInStep};
  for (int l = 0; l < std::min<int>(layer_level, attributes.index.finest_level); ++l) {
    found = child_in(layer.colored, found.cell, child_index(there, layer_level - 1 - l));
    if (found.state == LayerCell::kAbsent) return found;
  }
  return found;
}

PlacedSource::Cell PlacedSource::child(const Cell& above, const NumberedCell& cell,
                                       Vec3i place) const {
  Cell result = above;
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    const AttributeLayer& layer = layers_[i];
    // At voxels, the reader finds the cell faster.
    if (above[i].state == LayerCell::kUnknown && cell.level < dag_.levels)
      result[i] = find_cell(layer, cell.level, place);
    else if (above[i].state == LayerCell::kInStep &&
             above[i].cell.level < layer.colored.attributes.index.finest_level)
      result[i] = child_in(layer.colored, above[i].cell, child_index(place, 0));
  }
  return result;
}

std::optional<StoredRun> PlacedSource::run(const Cell& at, const NumberedCell& cell) const {
  std::size_t i = 0;
  while (i < layers_.size() && at[i].state == LayerCell::kAbsent) ++i;
  if (i == layers_.size() || at[i].state == LayerCell::kUnknown || !has_runs_[i]) return {};
  const bool is_equal =
      cell.level >= finest_ ||
      classes_.of(dag_, cell) == layer_classes_[i].of(layers_[i].colored.dag, at[i].cell);
  return is_equal ? std::optional(StoredRun{i, at[i].cell.number}) : std::nullopt;
}

PlacedSource::Reader::Reader(const PlacedSource& source) : source_(source) {
  for (std::size_t i = 0; i < source.layers_.size(); ++i) {
    const ColoredDagView& colored = source.layers_[i].colored;
    layers_.push_back({NumberFinder(colored.dag, colored.attributes.index),
                       StoredReader(source.stored(i)),
                       false,
                       {},
                       {},
                       false});
  }
}

CellValues PlacedSource::Reader::read(std::size_t layer, std::uint64_t number) {
  CellValues values = layers_[layer].stored.values(number);
  values.normal = turned(values.normal, source_.layers_[layer].orientation);
  return values;
}

/// Returns the values of the layer's voxel that is nearest to a voxel of the result.
const CellValues& PlacedSource::Reader::nearest(std::size_t i, Vec3i voxel) {
  Layer& layer = layers_[i];
  if (layer.has_nearest) return layer.nearest;
  const AttributeLayer& of = source_.layers_[i];
  const Vec3d centre = static_cast<Vec3d>(layer_voxel(of, voxel)) + Vec3d{0.5, 0.5, 0.5};
  std::uint64_t number = 0;
  layer.finder.find(nearest_voxel(of.colored.dag, centre)->voxel, number);
  layer.nearest = read(i, number);
  layer.has_nearest = true;
  return layer.nearest;
}

/// Returns the values of the first layer that has the voxel and, by has(attributes), the kind; else
/// the nearest ones of the first layer that has the kind; null if they are given.
template <class Has>
const CellValues* PlacedSource::Reader::find(const Has& has, bool is_given, Vec3i voxel) {
  std::size_t first = layers_.size();
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    if (!has(source_.layers_[i].colored.attributes)) continue;
    if (layers_[i].is_here) return &layers_[i].here;
    first = std::min(first, i);
  }
  return is_given ? nullptr : &nearest(first, voxel);
}

CellValues PlacedSource::Reader::values(const Cell&, Vec3i voxel) {
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    std::uint64_t number = 0;
    layers_[i].has_nearest = false;
    layers_[i].is_here = layers_[i].finder.find(layer_voxel(source_.layers_[i], voxel), number);
    if (layers_[i].is_here) layers_[i].here = read(i, number);
  }
  const NewValues& given = source_.new_values_;
  CellValues result;
  if (source_.kinds_.colors) {
    const auto* const from =
        find([](const auto& of) { return of.has_colors(); }, given.color.has_value(), voxel);
    result.color = from != nullptr ? from->color : *given.color;
  }
  if (source_.kinds_.normals)
    result.normal = find([](const auto& of) { return of.has_normals(); }, false, voxel)->normal;
  if (source_.kinds_.materials != 0) {
    const auto* const from =
        find([](const auto& of) { return of.has_materials(); }, given.material.has_value(), voxel);
    result.material = from != nullptr ? from->material : *given.material;
  }
  return result;
}

}  // namespace voxdag
