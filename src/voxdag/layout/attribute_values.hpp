#pragma once
/// What colour blocks and normal blocks have in common.

namespace voxdag {

/// Values of an attribute block: the eight child slots of each of two consecutive descriptors.
inline constexpr int kValuesPerBlock = 16;

}  // namespace voxdag
