#pragma once
/// A vector of three components: points, directions and voxel coordinates.
#include <cmath>
#include <cstdint>

#include "voxdag/core/host_device.hpp"

namespace voxdag {

template <class T>
struct Vec3 {
  T x{}, y{}, z{};

  VOXDAG_HD constexpr T& operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
  VOXDAG_HD constexpr const T& operator[](int axis) const {
    return axis == 0 ? x : axis == 1 ? y : z;
  }
  template <class U>
  VOXDAG_HD constexpr explicit operator Vec3<U>() const {
    return {static_cast<U>(x), static_cast<U>(y), static_cast<U>(z)};
  }
  friend bool operator==(const Vec3&, const Vec3&) = default;
};

using Vec3f = Vec3<float>;
using Vec3d = Vec3<double>;
using Vec3i = Vec3<std::int32_t>;
using Vec3l = Vec3<std::int64_t>;

template <class T>
VOXDAG_HD constexpr Vec3<T> operator+(Vec3<T> a, Vec3<T> b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
VOXDAG_HD constexpr Vec3<T> operator-(Vec3<T> a, Vec3<T> b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
VOXDAG_HD constexpr Vec3<T> operator-(Vec3<T> a) {
  return {-a.x, -a.y, -a.z};
}
/// Returns the component-wise product.
template <class T>
VOXDAG_HD constexpr Vec3<T> operator*(Vec3<T> a, Vec3<T> b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class T>
VOXDAG_HD constexpr Vec3<T> operator*(Vec3<T> a, T s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class T>
VOXDAG_HD constexpr T dot(Vec3<T> a, Vec3<T> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
VOXDAG_HD constexpr Vec3<T> cross(Vec3<T> a, Vec3<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
VOXDAG_HD constexpr Vec3<T> min(Vec3<T> a, Vec3<T> b) {
  return {a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z};
}
template <class T>
VOXDAG_HD constexpr Vec3<T> max(Vec3<T> a, Vec3<T> b) {
  return {a.x < b.x ? b.x : a.x, a.y < b.y ? b.y : a.y, a.z < b.z ? b.z : a.z};
}

/// Compares x, then y, then z.
inline bool is_before(Vec3i a, Vec3i b) {
  return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

/// Returns whether no component is infinite or NaN.
VOXDAG_HD inline bool is_finite(Vec3f v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}
VOXDAG_HD inline bool is_finite(Vec3d v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

VOXDAG_HD inline double length(Vec3d v) { return std::sqrt(dot(v, v)); }
VOXDAG_HD inline float length(Vec3f v) { return std::sqrt(dot(v, v)); }

/// Returns v scaled to unit length. Its squared length must be neither zero nor infinite.
VOXDAG_HD inline Vec3d normalized(Vec3d v) { return v * (1.0 / std::sqrt(dot(v, v))); }
VOXDAG_HD inline Vec3f normalized(Vec3f v) { return v * (1.0f / std::sqrt(dot(v, v))); }

/// Returns v scaled to unit length, or `otherwise` if v's squared length is zero, infinite or NaN.
VOXDAG_HD inline Vec3d normalized_or(Vec3d v, Vec3d otherwise) {
  const double length2 = dot(v, v);
  return length2 > 0 && length2 < HUGE_VAL ? v * (1.0 / std::sqrt(length2)) : otherwise;
}
VOXDAG_HD inline Vec3f normalized_or(Vec3f v, Vec3f otherwise) {
  const float length2 = dot(v, v);
  return length2 > 0 && length2 < HUGE_VALF ? v * (1.0f / std::sqrt(length2)) : otherwise;
}

}  // namespace voxdag
