#pragma once
/// Encodes sixteen normals as a normal block.
#include <cstdint>
#include <span>

#include "voxdag/layout/normal_block.hpp"

namespace voxdag {

/// Returns a block whose decoded normals are close to the used ones of `normals`, by the sum of
/// squared chords. Typical errors (`attribute_codecs` in bench/ measures them): equal normals 0.001
/// degrees; normals of a smooth surface that spread over an angle A, A / 35 in the mean; two
/// unrelated directions half a degree, three two degrees.
///
/// Bit i of `used` is set if value i counts; unused ones are not read. Normals may have any length;
/// one without a direction (zero, NaN or infinite) does not count. `weights`, if given, are
/// positive and finite. The bits depend on the arguments alone, on any machine. Thread-safe.
NormalBlock encode_normal_block(std::span<const Vec3f, kValuesPerBlock> normals, std::uint32_t used,
                                const float* weights = nullptr);

}  // namespace voxdag
