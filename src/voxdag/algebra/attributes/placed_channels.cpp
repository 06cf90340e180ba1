#include "voxdag/algebra/attributes/placed_channels.hpp"

#include <algorithm>

#include "voxdag/algebra/attributes/channel_of_voxels.hpp"
#include "voxdag/algebra/query/nearest_voxel.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/stored/attributes/build_cell_index.hpp"

namespace voxdag {
namespace {

/// A layer that has the channel.
struct ChannelLayer {
  const AttributeLayer& of;
  ChannelView channel;
  NumberFinder finder;

  Vec3i voxel_at(Vec3i voxel) const {
    return source_cell(of.orientation, voxel - of.offset, of.colored.dag.levels);
  }
  bool find(Vec3i voxel, double& value) {
    std::uint64_t number = 0;
    if (!finder.find(voxel_at(voxel), number)) return false;
    value = channel.read(number);
    return true;
  }
  double nearest(Vec3i voxel) {
    const Vec3d centre = static_cast<Vec3d>(voxel_at(voxel)) + Vec3d{0.5, 0.5, 0.5};
    std::uint64_t number = 0;
    finder.find(nearest_voxel(of.colored.dag, centre)->voxel, number);
    return channel.read(number);
  }
};

}  // namespace

void add_placed_channels(DagAttributes& attributes, const SvdagView& dag, int finest_level,
                         std::span<const AttributeLayer> layers, Work work) {
  std::vector<ChannelSpec> specs;
  for (const AttributeLayer& layer : layers) {
    const ChannelsView channels = layer.colored.attributes.channels;
    for (std::size_t i = 0; i < channels.count(); ++i) {
      const ChannelSpec spec = spec_of(channels[i]);
      const auto same = std::find_if(specs.begin(), specs.end(),
                                     [&](const auto& of) { return of.name == spec.name; });
      if (same == specs.end()) {
        specs.push_back(spec);
        continue;
      }
      if (same->kind != spec.kind)
        same->kind = same->kind == ChannelKind::kF32 || spec.kind == ChannelKind::kF32
                         ? ChannelKind::kF32
                         : ChannelKind::kI32;
      same->bound = std::max(same->bound, spec.bound);
    }
  }
  if (specs.empty() || dag.is_empty()) return;
  if (specs.size() > kMaxChannels)
    throw Error("the result would have " + std::to_string(specs.size()) +
                " channels, and at most " + std::to_string(kMaxChannels) + " are stored");
  if (attributes.index.cells == 0)
    attributes.index = build_cell_index(dag, finest_level, work.memory);
  const CellIndexView index = attributes.index.view();
  std::vector<EncodedChannel> channels;
  for (const ChannelSpec& spec : specs) {
    std::vector<ChannelLayer> of_channel;
    for (const AttributeLayer& layer : layers) {
      const ChannelsView given = layer.colored.attributes.channels;
      const std::size_t i = given.find(spec.name);
      if (i < given.count())
        of_channel.push_back(
            {layer, given[i], NumberFinder(layer.colored.dag, layer.colored.attributes.index)});
    }
    channels.push_back(channel_of_voxels(
        dag, index, spec,
        [&](Vec3i voxel) {
          double value = 0;
          for (ChannelLayer& layer : of_channel)
            if (layer.find(voxel, value)) return value;
          return of_channel.front().nearest(voxel);
        },
        work));
  }
  attributes.channels = join_channels(index.cells, channels);
}

}  // namespace voxdag
