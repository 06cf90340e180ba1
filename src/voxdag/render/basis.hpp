#pragma once
/// An orthonormal frame around a unit vector.

#include "voxdag/core/vec.hpp"

namespace voxdag {

/// Two unit vectors that form a right-handed frame with `normal`.
template <class T>
struct Basis {
  Vec3<T> u, v;
};

/// Returns the frame of a unit vector. Source: T. Duff and others, "Building an Orthonormal Basis,
/// Revisited", JCGT 6(1), 2017.
template <class T>
VOXDAG_HD inline Basis<T> make_basis(Vec3<T> normal) {
  const T sign = normal.z < 0 ? T(-1) : T(1);
  const T a = T(-1) / (sign + normal.z);
  const T b = normal.x * normal.y * a;
  return {{T(1) + sign * normal.x * normal.x * a, sign * b, -sign * normal.x},
          {b, sign + normal.y * normal.y * a, -normal.y}};
}

}  // namespace voxdag
