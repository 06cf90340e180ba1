#pragma once
/// Attributes of DAGs with metallic and roughness, for tests of pictures.
#include <array>
#include <functional>

#include "support/brute_svdag.hpp"
#include "voxdag/stored/attributes/build_cell_index.hpp"
#include "voxdag/stored/attributes/dag_attributes.hpp"
#include "voxdag/stored/attributes/encode_channels.hpp"

namespace voxdag {

/// Returns attributes of all cells of a DAG: one colour (sRGB), and channels of the kind u8 whose
/// values are numbers_of(number of the cell). Without `with_channels` only the colour.
inline DagAttributes mirror_attributes(
    const SvdagView& dag, Value8 color, bool with_channels,
    const std::function<std::array<std::uint8_t, 2>(std::uint64_t)>& numbers_of) {
  DagAttributes attributes;
  attributes.index = build_cell_index(dag, dag.levels);
  ValueEncoder colors(attributes.index.cells, make_value_metric(kColorWeights, 0), nullptr);
  std::array<std::vector<std::uint8_t>, 2> values;
  for (std::uint64_t number = 0; number < attributes.index.cells; ++number) {
    colors.add(number, {&color, 1});
    const std::array<std::uint8_t, 2> numbers = numbers_of(number);
    for (std::size_t i = 0; i < 2; ++i) values[i].push_back(numbers[i]);
  }
  attributes.colors = colors.finish();
  if (!with_channels) return attributes;
  const std::array<EncodedChannel, 2> channels = {
      encode_channel({"metallic", ChannelKind::kU8, 0}, std::span<const std::uint8_t>(values[0])),
      encode_channel({"roughness", ChannelKind::kU8, 0}, std::span<const std::uint8_t>(values[1]))};
  attributes.channels = join_channels(attributes.index.cells, channels);
  return attributes;
}

}  // namespace voxdag
