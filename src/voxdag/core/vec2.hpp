#pragma once
/// A vector of two components: texture coordinates, barycentric coordinates.
#include "voxdag/core/host_device.hpp"

namespace voxdag {

template <class T>
struct Vec2 {
  T x{}, y{};

  friend bool operator==(const Vec2&, const Vec2&) = default;
};

using Vec2f = Vec2<float>;
using Vec2d = Vec2<double>;

template <class T>
VOXDAG_HD constexpr Vec2<T> operator+(Vec2<T> a, Vec2<T> b) {
  return {a.x + b.x, a.y + b.y};
}
template <class T>
VOXDAG_HD constexpr Vec2<T> operator-(Vec2<T> a, Vec2<T> b) {
  return {a.x - b.x, a.y - b.y};
}
template <class T>
VOXDAG_HD constexpr Vec2<T> operator*(Vec2<T> a, T s) {
  return {a.x * s, a.y * s};
}
/// Returns twice the signed area of the triangle (0, a, b): positive if it is counter-clockwise.
template <class T>
VOXDAG_HD constexpr T cross(Vec2<T> a, Vec2<T> b) {
  return a.x * b.y - a.y * b.x;
}

}  // namespace voxdag
