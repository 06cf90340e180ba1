#pragma once
/// The attributes of DAGs that were made from other DAGs by moving, turning, cutting, joining and
/// growing them.
#include "voxdag/algebra/attributes/placed_source.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/attributes/coarsen_attributes.hpp"

namespace voxdag {

/// Returns the attributes of `dag`, a valid DAG whose voxels come from one or two layers. It has
/// the kinds of values that any layer has. For each kind, a voxel has the value of the first layer
/// with this kind that has a cell of its finest level with attributes at the voxel. A new voxel,
/// for which no layer has one, has the value of `new_values`, else that of the layer's voxel that
/// is nearest to its centre (algebra/query/nearest_voxel.hpp says which one of equally near ones),
/// in the first layer with this kind. Normals turn with their layer. Each channel is a kind
/// (placed_channels.hpp); `new_values` has none.
///
/// The finest cells with attributes have the size of the smallest ones of the layers, so that no
/// layer loses values. derive_attributes() makes the values of cells from those of voxels, and says
/// what it throws. Subtrees of the first layer that are still at a cell of their size keep all
/// values. `material_ids` of the layers must map to ids below `materials`, which is the number of
/// materials of the result; 0: that of the first layer with materials.
DagAttributes placed_attributes(const SvdagView& dag, std::span<const AttributeLayer> layers,
                                const NewValues& new_values = {}, std::uint32_t materials = 0,
                                const CoarsenBounds& bounds = {}, Work work = {});

}  // namespace voxdag
