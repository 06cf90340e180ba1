#pragma once
/// Finds the axis along which most vectors of a set lie.
#include "voxdag/core/vec.hpp"

namespace voxdag {

/// The sum of the outer products w v vᵀ of vectors v with weights w: a symmetric 3×3 matrix.
struct OuterProductSum {
  float xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;

  /// Adds a vector. Its sign does not matter.
  void add(Vec3f v, float weight) {
    const Vec3f w = v * weight;
    xx += w.x * v.x, xy += w.x * v.y, xz += w.x * v.z;
    yy += w.y * v.y, yz += w.y * v.z, zz += w.z * v.z;
  }

  void add(const OuterProductSum& other) {
    xx += other.xx, xy += other.xy, xz += other.xz;
    yy += other.yy, yz += other.yz, zz += other.zz;
  }

  /// Returns an eigenvector, of any length, of the greatest eigenvalue (approximately). The matrix
  /// must not be zero.
  Vec3f principal_axis() const {
    // Squaring the matrix three times almost makes it the projection onto the axis: its longest row
    // then lies along the axis.
    OuterProductSum m = *this;
    float norm = 1.0f / (xx + yy + zz);
    for (int i = 0; i < 3; ++i) {
      m.xx *= norm, m.xy *= norm, m.xz *= norm, m.yy *= norm, m.yz *= norm, m.zz *= norm;
      m = {m.xx * m.xx + m.xy * m.xy + m.xz * m.xz, m.xx * m.xy + m.xy * m.yy + m.xz * m.yz,
           m.xx * m.xz + m.xy * m.yz + m.xz * m.zz, m.xy * m.xy + m.yy * m.yy + m.yz * m.yz,
           m.xy * m.xz + m.yy * m.yz + m.yz * m.zz, m.xz * m.xz + m.yz * m.yz + m.zz * m.zz};
      norm = 1.0f / (m.xx + m.yy + m.zz);
    }
    return m.xx >= m.yy && m.xx >= m.zz ? Vec3f{m.xx, m.xy, m.xz}
           : m.yy >= m.zz               ? Vec3f{m.xy, m.yy, m.yz}
                                        : Vec3f{m.xz, m.yz, m.zz};
  }
};

}  // namespace voxdag
