#include "voxdag/stored/attributes/material_colors.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "voxdag/core/parallel/polled_for.hpp"
#include "voxdag/stored/attributes/dag_attributes.hpp"

namespace voxdag {

Value8 material_color(std::uint32_t id) {
  // Steps of the golden ratio give near ids distant hues. Three brightnesses tell other ids apart.
  const double hue = 6 * std::fmod(0.08 + id * 0.6180339887498949, 1.0);
  const double value = id % 3 == 0 ? 1.0 : id % 3 == 1 ? 0.8 : 0.62;
  Value8 color{};
  for (int c = 0; c < 3; ++c) {
    const double k = std::fmod(5 - 2 * c + hue, 6.0);
    const double part = std::clamp(std::min(k, 4 - k), 0.0, 1.0);
    color[c] = static_cast<std::uint8_t>(std::lround(255 * value * (1 - 0.65 * part)));
  }
  return color;
}

ValuePages material_colors(const MaterialIdsView& ids, Work work) {
  ValueEncoder encoder(ids.values, make_value_metric(kColorWeights, 0), nullptr);
  polled_for(ids.page_count(), 256, work, "materials", [&](std::size_t page) {
    const std::uint64_t first = page * std::uint64_t{kPageValues};
    const auto count =
        static_cast<std::size_t>(std::min<std::uint64_t>(kPageValues, ids.values - first));
    std::array<Value8, kPageValues> colors;
    for (std::size_t i = 0; i < count; ++i)
      colors[i] = material_color(read_material(ids, first + i));
    encoder.add(first, std::span(colors).first(count));
  });
  return encoder.finish();
}

}  // namespace voxdag
