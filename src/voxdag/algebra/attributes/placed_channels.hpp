#pragma once
/// The channels of DAGs that were made from other DAGs.
#include "voxdag/algebra/attributes/placed_source.hpp"
#include "voxdag/stored/attributes/dag_attributes.hpp"

namespace voxdag {

/// Gives `attributes`, which are those of `dag` down to its level `finest_level`, or empty, the
/// channels that any layer has: at most kMaxChannels, those of the first layer first. For each, a
/// voxel has the value of the first layer with this channel that has a cell at the voxel; else that
/// of the voxel that is nearest to its centre, in the first layer with this channel. A channel
/// has the kind and the bound of its layer. Where those of two layers differ, it has the larger
/// bound, and of two kinds f32 if one is f32, which rounds whole numbers beyond 2^24, else i32.
/// Throws Error for too many channels; OverMemory and Cancelled.
void add_placed_channels(DagAttributes& attributes, const SvdagView& dag, int finest_level,
                         std::span<const AttributeLayer> layers, Work work = {});

}  // namespace voxdag
