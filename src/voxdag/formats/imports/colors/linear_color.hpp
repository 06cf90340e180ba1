#pragma once
/// Colours in linear light as whole numbers, so that sums do not depend on their order.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "voxdag/core/srgb.hpp"

namespace voxdag {

/// Returns the linear light, 0 to 65535, of an sRGB encoded channel.
inline std::uint16_t linear_of(std::uint8_t encoded) {
  static const auto kTable = [] {
    std::array<std::uint16_t, 256> table{};
    for (std::size_t c = 0; c < 256; ++c)
      table[c] = static_cast<std::uint16_t>(
          std::lround(srgb_to_linear(static_cast<float>(c) / 255.0f) * 65535.0f));
    return table;
  }();
  return kTable[encoded];
}

/// Returns the sRGB encoded channel that is nearest to a linear light: the inverse of linear_of().
inline std::uint8_t encoded_of(std::uint16_t linear) {
  /// The greatest linear lights of channels 0 to 254.
  static const auto kGreatest = [] {
    std::array<std::uint16_t, 255> greatest{};
    for (std::size_t c = 0; c < 255; ++c)
      greatest[c] = static_cast<std::uint16_t>(
          srgb_to_linear((static_cast<float>(c) + 0.5f) / 255.0f) * 65535.0f);
    return greatest;
  }();
  return static_cast<std::uint8_t>(std::lower_bound(kGreatest.begin(), kGreatest.end(), linear) -
                                   kGreatest.begin());
}

}  // namespace voxdag
