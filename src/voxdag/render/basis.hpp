#pragma once
/// Unit vectors and the frames around them.
#include <cmath>

#include "voxdag/core/vec.hpp"

namespace voxdag {

VOXDAG_HD inline Vec3d normalized(Vec3d v) { return v * (1.0 / std::sqrt(dot(v, v))); }
VOXDAG_HD inline Vec3f normalized(Vec3f v) { return v * (1.0f / std::sqrt(dot(v, v))); }

/// Two unit vectors that with `normal` make a right-handed frame.
template <class T>
struct Basis {
  Vec3<T> u, v;
};

/// Source: Duff and others, "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017.
template <class T>
VOXDAG_HD inline Basis<T> make_basis(Vec3<T> normal) {
  const T sign = normal.z < 0 ? T(-1) : T(1);
  const T a = T(-1) / (sign + normal.z);
  const T b = normal.x * normal.y * a;
  return {{T(1) + sign * normal.x * normal.x * a, sign * b, -sign * normal.x},
          {b, sign + normal.y * normal.y * a, -normal.y}};
}

}  // namespace voxdag
