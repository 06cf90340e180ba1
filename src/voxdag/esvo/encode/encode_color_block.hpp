#pragma once
/// Encodes sixteen colours as a colour block.
#include <cstdint>
#include <span>

#include "voxdag/layout/color_block.hpp"

namespace voxdag {

/// Returns a block whose decoded values are close to the used ones of `colors`, by the sum of
/// squared differences over red, green and blue. With up to five values its error is within a few
/// percent of the optimum.
///
/// `colors` are sRGB-encoded, in [0,1] (other values are clamped, NaN is 0). Bit i of `used` is set
/// if value i counts; unused values get selector 0, and their colours are not read. `weights`, if
/// given, are positive and finite factors on the squared differences. The bits depend on the
/// arguments alone, on any machine. Thread-safe.
ColorBlock encode_color_block(std::span<const Vec3f, kValuesPerBlock> colors, std::uint32_t used,
                              const float* weights = nullptr);

}  // namespace voxdag
