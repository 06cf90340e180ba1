#pragma once
/// What readers check of vertices.
#include <cmath>

#include "voxdag/core/vec.hpp"

namespace voxdag {

inline bool is_finite(Vec3f p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

}  // namespace voxdag
