#pragma once
/// Sixteen normals to a normal block.
#include <cstdint>
#include <span>

#include "voxdag/layout/normal_block.hpp"

namespace voxdag {

/// A block whose decoded normals lie close to the used ones of `normals`: by the sum of squared
/// chords. Equal normals are met to 0.001 degrees; normals of a smooth surface that spread over an
/// angle A by A / 35 in the mean; two entirely different directions by half a degree and three by
/// two (`attribute_codecs` in bench/ measures them).
///
/// Bit i of `used` tells if value i counts; the others are not read. Normals may have any length;
/// one without a direction (zero, NaN or infinite) does not count. `weights`, where given, are
/// positive and finite. The bits depend on the arguments alone, on any machine. Thread-safe.
NormalBlock encode_normal_block(std::span<const Vec3f, kValuesPerBlock> normals, std::uint32_t used,
                                const float* weights = nullptr);

}  // namespace voxdag
