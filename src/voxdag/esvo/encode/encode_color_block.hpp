#pragma once
/// Sixteen colours to a colour block.
#include <cstdint>
#include <span>

#include "voxdag/layout/color_block.hpp"

namespace voxdag {

/// The block whose decoded values have the least sum of squared differences, over red, green and
/// blue, from the used ones of `colors`, or nearly so: on blocks of up to five values its error is
/// within a few percent of the optimum.
///
/// `colors` are sRGB-encoded, in [0,1] (what lies outside is clamped, NaN is 0). Bit i of `used`
/// tells if value i counts; the selectors of the others are 0 and their colours are not read.
/// `weights`, where given, are positive and finite: how much a value's squared difference counts.
/// The bits depend on the arguments alone, on any machine. Thread-safe.
ColorBlock encode_color_block(std::span<const Vec3f, kValuesPerBlock> colors, std::uint32_t used,
                              const float* weights = nullptr);

}  // namespace voxdag
