#include "voxdag/stored/attributes/channel_colors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>

#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/stored/attributes/dag_attributes.hpp"

namespace voxdag {

Value8 mapped_color(double place) {
  constexpr std::size_t kLast = std::size(kColorMap) - 1;
  const double at = place > 0 ? std::min(place, 1.0) * static_cast<double>(kLast) : 0;
  const auto first = std::min(static_cast<std::size_t>(at), kLast - 1);
  const double part = at - static_cast<double>(first);
  Value8 color{};
  for (int c = 0; c < 3; ++c)
    color[c] = static_cast<std::uint8_t>(
        std::lround(kColorMap[first][c] + part * (kColorMap[first + 1][c] - kColorMap[first][c])));
  return color;
}

ValuePages channel_colors(const ChannelView& channel, const ChannelRange& range, Work work) {
  ValueEncoder encoder(channel.values, make_value_metric(kColorWeights, 0), nullptr);
  static_assert(kPageValues == kChannelBlockValues);
  const double size = range.most - range.least;
  polled_for(channel.block_count(), 256, work, "channel", [&](std::size_t i) {
    const std::uint64_t first = i * kChannelBlockValues;
    const auto count = static_cast<std::size_t>(
        std::min<std::uint64_t>(kChannelBlockValues, channel.values - first));
    const ChannelBlock block = channel.block(i);
    std::array<Value8, kPageValues> colors;
    for (std::size_t k = 0; k < count; ++k)
      colors[k] = mapped_color(size > 0 ? (channel.read(block, k) - range.least) / size : 0);
    encoder.add(first, std::span(colors).first(count));
  });
  return encoder.finish();
}

}  // namespace voxdag
