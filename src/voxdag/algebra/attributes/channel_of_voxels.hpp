#pragma once
/// The channels of a DAG's cells, from the values of its voxels.
///
/// A cell of the finest level with attributes, m, has the mean of its voxels; usually m = L, so
/// that the cell is a voxel. A cell above has the mean of its children as they are given to the
/// encoder, each with the weight of the cells of level m in it. Means are sums in double, in Morton
/// order; a whole number is rounded to the nearest, of two equally near ones to the greater.
#include <functional>

#include "voxdag/stored/attributes/cell_index.hpp"
#include "voxdag/stored/attributes/encode_channels.hpp"

namespace voxdag {

/// Returns a channel of all cells that `index` numbers. `value_of` returns the values of the
/// voxels; it is called once for each, in Morton order. Counts 4 bytes for each cell in `work`
/// until it returns. Throws Error for values that the kind does not have (channel_code()),
/// OverMemory, Cancelled, and what `value_of` throws.
EncodedChannel channel_of_voxels(const SvdagView& dag, const CellIndexView& index,
                                 const ChannelSpec& spec,
                                 const std::function<double(Vec3i)>& value_of, Work work = {});

}  // namespace voxdag
