#pragma once
/// The number of values in an attribute block, for colours and for normals.

namespace voxdag {

/// One value for each of the eight child slots of two consecutive descriptors.
inline constexpr int kValuesPerBlock = 16;

}  // namespace voxdag
