#include "voxdag/algebra/attributes/placed_attributes.hpp"

#include <algorithm>

#include "voxdag/algebra/attributes/derive_attributes.hpp"
#include "voxdag/algebra/attributes/placed_channels.hpp"

namespace voxdag {

DagAttributes placed_attributes(const SvdagView& dag, std::span<const AttributeLayer> layers,
                                const NewValues& new_values, std::uint32_t materials,
                                const CoarsenBounds& bounds, Work work) {
  ValueKinds kinds;
  int cut = kMaxLevels;  // log2 of the side of the finest cells, in voxels
  for (const AttributeLayer& layer : layers) {
    const ValueKinds of = kinds_of(layer.colored.attributes);
    kinds.colors |= of.colors;
    kinds.normals |= of.normals;
    if (kinds.materials == 0) kinds.materials = of.materials;
    if (kinds.materials != 0 && materials != 0) kinds.materials = materials;
    cut = std::min(cut, layer.colored.dag.levels - layer.colored.attributes.index.finest_level);
  }
  const int finest = std::max(dag.levels - cut, 0);
  DagAttributes result;
  if (!dag.is_empty() && !kinds.is_empty()) {
    const PlacedSource source(dag, finest, layers, new_values, kinds, work.memory);
    result = derive_attributes(dag, finest, source, bounds, work);
  }
  add_placed_channels(result, dag, finest, layers, work);
  return result;
}

}  // namespace voxdag
