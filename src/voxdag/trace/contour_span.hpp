#pragma once
/// Where a ray is between the two planes of a contour.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 3.2 and line 14 of
/// Figure 8.
///
/// In the mirrored coordinates of grid_ray.hpp, with the voxel's centre C, half of its side h and
/// the contour's normal n (mirrored like the ray), the ray is at O - T d, and between the planes
/// while
///     h position(low) <= n.(O - C) - T n.d <= h position(high).
/// O and C are multiples of 2^-23 and n consists of small integers, so n.(O - C) is computed
/// without any error in 32 bits, however far the voxel is; so are the bounds, times 127, in 64
/// bits. What is rounded is d, to multiples of 2^-24, and the quotient at last. All is integer but
/// two products that nothing is added to: every machine finds the same T, as for the planes of
/// cubes.
///
/// No holes. Let u = 2^-24 and |n| the sum of n's components. d is off by less than 1.25 u for each
/// axis, so T n.d by 1.25 u |n| T; the quotient takes five roundings, which are as good as 5 u |n|
/// T in the numerator; and a cube's T, where the cube ends though the line may not have left it
/// yet, has one, so 2 u |n| T for both of its ends. The planes are moved outwards by 16 u |n| T, T
/// being where the ray leaves the cube: more than all of these together. So a ray whose line meets
/// the exact shape of a voxel it is in meets the voxel. At a distance of a thousand pixels per
/// radian that is less than 1/500 pixel.
#include "voxdag/layout/contour.hpp"
#include "voxdag/trace/grid_ray.hpp"

namespace voxdag {

/// A range of T; empty if t_enter > t_leave.
struct ContourSpan {
  float t_enter, t_leave;
};

/// A ray as contours see it.
class ContourRay {
 public:
  VOXDAG_HD explicit ContourRay(const GridRay& ray) {
    for (int axis = 0; axis < 3; ++axis) {
      const bool is_mirrored = (ray.mirrored >> axis & 1u) != 0;
      const bool is_still = (ray.parallel >> axis & 1u) != 0;
      origin_[axis] = static_cast<std::int32_t>(bits_of_float(ray.origin[axis]));
      const auto d = static_cast<std::int32_t>(0x1p24f / ray.inverse[axis]);
      direction_[axis] = is_still ? 0 : is_mirrored ? -d : d;
      sign_[axis] = is_mirrored ? -1 : 0;
    }
  }

  /// Of the voxel with its lower corner at the float bits (x,y,z), of 1 << bit in units of 2^-23,
  /// which the ray leaves at `t_exit`.
  VOXDAG_HD ContourSpan span(Contour contour, std::uint32_t x, std::uint32_t y, std::uint32_t z,
                             int bit, float t_exit) const {
    const Vec3i n = contour.normal();
    const std::int32_t n1 = length1(n);
    const std::int32_t half = std::int32_t{1} << (bit - 1);
    // The normal times the ray's mirrored vectors is that of vectors mirrored once more, back.
    const Vec3i to_origin{unmirrored(origin_.x - static_cast<std::int32_t>(x) - half, sign_.x),
                          unmirrored(origin_.y - static_cast<std::int32_t>(y) - half, sign_.y),
                          unmirrored(origin_.z - static_cast<std::int32_t>(z) - half, sign_.z)};
    const std::int64_t at = std::int64_t{dot(n, to_origin)} * Contour::kMaxPosition;
    const std::int32_t fall = dot(n, direction_);
    // 127 * 2^23 * 16 u = 1016 < 1024
    const std::int32_t slack = n1 * (static_cast<std::int32_t>(t_exit * 1024.0f) + 1);
    const std::int64_t high = at - bound(n1, contour.high(), half) - slack;
    const std::int64_t low = at - bound(n1, contour.low(), half) + slack;
    // at and bounds are in units of 2^-23 / 127, fall in 2^-24.
    const float inverse = (2.0f / Contour::kMaxPosition) / static_cast<float>(fall);
    const float t_high = static_cast<float>(high) * inverse;
    const float t_low = static_cast<float>(low) * inverse;
    return fall >= 0 ? ContourSpan{t_high, t_low} : ContourSpan{t_low, t_high};
  }

  /// The outward normal, not of unit length, of the plane by which the ray comes between the two.
  VOXDAG_HD Vec3i entered_normal(Contour contour) const {
    const Vec3i n = contour.normal();
    return dot(n, direction_) >= 0 ? n : -n;
  }

 private:
  VOXDAG_HD static std::int32_t unmirrored(std::int32_t v, std::int32_t sign) {
    return (v ^ sign) - sign;
  }
  VOXDAG_HD static std::int64_t bound(std::int32_t n1, int position, std::int32_t half) {
    return std::int64_t{n1 * (2 * position - Contour::kMaxPosition)} * half;
  }

  Vec3i origin_;     ///< Float bits.
  Vec3i direction_;  ///< Minus that of the ray, not mirrored, in 2^-24.
  Vec3i sign_;       ///< -1 on mirrored axes.
};

}  // namespace voxdag
