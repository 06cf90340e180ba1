#pragma once
/// Encodes sixteen normals as a normal block.
#include <cstdint>
#include <span>

#include "voxdag/stored/esvo/normal_block.hpp"

namespace voxdag {

/// Returns a block whose decoded normals are close to the used values of `normals`, by the sum of
/// squared chords. Mean errors: 0.001 degrees for equal normals; A / 35 for a smooth surface whose
/// normals spread over an angle A; half a degree for two entirely different directions and two
/// degrees for three (`attribute_codecs` in bench/ measures them).
///
/// Bit i of `used` tells if value i counts; unused values are not read. Normals may have any
/// length; one without a direction (zero, NaN or infinite) does not count. `weights`, if they are
/// given, are positive and finite. The bits depend on the arguments alone, not on the machine.
/// Thread-safe.
NormalBlock encode_normal_block(std::span<const Vec3f, kValuesPerBlock> normals, std::uint32_t used,
                                const float* weights = nullptr);

}  // namespace voxdag
