#pragma once
/// How many values an attribute block holds, of colours and of normals alike.

namespace voxdag {

/// Values per block: one for each of the eight child slots of two consecutive descriptors.
inline constexpr int kValuesPerBlock = 16;

}  // namespace voxdag
