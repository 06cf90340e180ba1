#pragma once
/// Encodes sixteen colours as a colour block.
#include <cstdint>
#include <span>

#include "voxdag/stored/esvo/color_block.hpp"

namespace voxdag {

/// Returns a block whose decoded values are close to the used values of `colors`, by the sum of
/// squared differences of red, green and blue. For up to five values the error is within a few
/// percent of the optimum.
///
/// `colors` are sRGB-encoded, in [0,1]; other values are clamped and NaN becomes 0. Bit i of `used`
/// tells if value i counts; the selectors of unused values are 0 and their colours are not read.
/// `weights` of the squared differences, if they are given, are positive and finite. The bits
/// depend on the arguments alone, not on the machine. Thread-safe.
ColorBlock encode_color_block(std::span<const Vec3f, kValuesPerBlock> colors, std::uint32_t used,
                              const float* weights = nullptr);

}  // namespace voxdag
