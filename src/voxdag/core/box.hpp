#pragma once
/// An axis-aligned box. Each use says whether `hi` belongs to the box.
#include <limits>

#include "voxdag/core/vec.hpp"

namespace voxdag {

template <class T>
struct Box {
  Vec3<T> lo, hi;

  /// Returns the empty box. After extend() with some points it is their bounds.
  static constexpr Box empty() {
    constexpr T big = std::numeric_limits<T>::max(), small = std::numeric_limits<T>::lowest();
    return {{big, big, big}, {small, small, small}};
  }
  VOXDAG_HD constexpr void extend(Vec3<T> p) {
    lo = min(lo, p);
    hi = max(hi, p);
  }
  VOXDAG_HD constexpr bool is_empty() const { return hi.x < lo.x || hi.y < lo.y || hi.z < lo.z; }
  friend bool operator==(const Box&, const Box&) = default;
};

using Box3f = Box<float>;
using Box3d = Box<double>;
using Box3i = Box<std::int32_t>;

}  // namespace voxdag
