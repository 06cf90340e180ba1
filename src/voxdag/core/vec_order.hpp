#pragma once
/// An order of vectors.
#include "voxdag/core/vec.hpp"

namespace voxdag {

/// Compares x, then y, then z.
inline bool is_before(Vec3i a, Vec3i b) {
  return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

}  // namespace voxdag
