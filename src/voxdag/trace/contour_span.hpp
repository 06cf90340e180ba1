#pragma once
/// The span of T in which a ray is between the two planes of a contour.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 3.2 and line 14 of
/// Figure 8.
///
/// In the mirrored coordinates of grid_ray.hpp, with the voxel's centre C, half of its side h and
/// the contour's normal n (mirrored like the ray), the ray is at O - T d, and between the planes
/// while
///     h position(low) <= n.(O - C) - T n.d <= h position(high).
/// O and C are multiples of 2^-23 and n consists of small integers. So n.(O - C) is exact in 32
/// bits at any distance of the voxel. Rounding happens in the bounds (outwards, to units of 2^-23),
/// in d (to multiples of 2^-24) and in the final quotient. All arithmetic is integer except for two
/// products, to which nothing is added. So every machine finds the same T, as for the planes of
/// cubes.
///
/// n.d is made odd, so that it is never 0: a ray parallel to the planes crosses them far away.
///
/// No holes. Let u = 2^-24 and |n| the sum of n's components. d has an error below 1.25 u on each
/// axis, so T n.d has an error of 1.25 u |n| T, and another u T because it is made odd. The
/// quotient has four roundings, equivalent to 4 u |n| T in the numerator. The T of a cube's two
/// ends have one rounding each, together 2 u |n| T. The planes are moved outwards by 16 u |n| T,
/// with T at the ray's exit from the cube: more than the sum of all these errors. So if a ray is in
/// a voxel and its line meets the voxel's exact shape, the ray meets the voxel, and before the end
/// of the voxel's range. At a thousand pixels per radian the planes move by less than 1/500 pixel.
#include "voxdag/stored/esvo/contour.hpp"
#include "voxdag/trace/grid_ray.hpp"

namespace voxdag {

/// All T with t_enter <= T < t_leave.
struct ContourSpan {
  float t_enter, t_leave;
};

/// The planes of a voxel's contour: n.P = low and n.P = high, P in units of 2^-23 from the voxel's
/// centre, mirrored like the rays.
struct ContourSlab {
  Vec3i normal;
  std::int32_t length1;  ///< |n|1 of the normal.
  std::int32_t low, high;

  /// Makes the slab of a voxel whose side is 1 << `bit` in units of 2^-23.
  VOXDAG_HD static ContourSlab make(Contour contour, std::uint32_t mirrored, int bit) {
    const auto sign = [mirrored](int axis) {
      return -static_cast<std::int32_t>(mirrored >> axis & 1u);
    };
    const Vec3i n = contour.normal();
    ContourSlab slab;
    slab.normal = {(n.x ^ sign(0)) - sign(0), (n.y ^ sign(1)) - sign(1), (n.z ^ sign(2)) - sign(2)};
    slab.length1 = voxdag::length1(n);
    const std::int32_t low_steps = slab.length1 * (2 * contour.low() - Contour::kMaxPosition),
                       high_steps = slab.length1 * (2 * contour.high() - Contour::kMaxPosition);
    const std::int32_t wider = kWider + (slab.length1 << (bit - 1) >> kWiderShift);
    slab.low = (low_steps * kStep >> (kTopBit - bit)) - wider;
    slab.high = (high_steps * kStep >> (kTopBit - bit)) + wider;
    return slab;
  }
  /// h position(p) is the number of steps times 2^(bit - 1) / 127. It is computed as a product with
  /// 2^22 / 127 and a shift. Both round down, and so does slack(), by less than the planes are
  /// moved outwards.
  static constexpr std::int32_t kTopBit = 23, kStep = (1 << 22) / Contour::kMaxPosition;
  static constexpr std::int32_t kWider = 3, kWiderShift = 20;

  /// Returns the distance by which the planes are moved outwards for a ray that leaves the cube at
  /// t_exit: 16 u |n| T, in whole units.
  VOXDAG_HD std::int32_t slack(float t_exit) const {
    // Between 8192 and 8193 floats are 1/1024 apart: the difference of the bits counts 1024ths.
    const std::uint32_t reach = bits_of_float(t_exit + kReachBase) - bits_of_float(kReachBase);
    return length1 * (static_cast<std::int32_t>(reach) + 1) >> kReachShift;
  }
  static constexpr float kReachBase = 8192.0f;
  static constexpr int kReachShift = 7;
};

/// The integer form of a ray for its spans in contours, mirrored.
class ContourRay {
 public:
  VOXDAG_HD explicit ContourRay(const GridRay& ray) : mirrored_(ray.mirrored) {
    for (int axis = 0; axis < 3; ++axis) {
      origin_[axis] = static_cast<std::int32_t>(bits_of_float(ray.origin[axis]));
      direction_[axis] = direction(ray.inverse[axis]);
    }
  }

  /// Returns the component of a ray's direction along an axis, negated, in units of 2^-24; 0 along
  /// parallel axes.
  VOXDAG_HD static std::int32_t direction(float inverse) {
    return static_cast<std::int32_t>(kDirectionOne / inverse);
  }
  static constexpr float kDirectionOne = 0x1p24f;

  /// Returns the span in the contour of a voxel whose lower corner has the float bits (x,y,z) and
  /// whose side is 1 << bit in units of 2^-23. `t_exit` is where the ray leaves the voxel's cube.
  VOXDAG_HD ContourSpan span(Contour contour, std::uint32_t x, std::uint32_t y, std::uint32_t z,
                             int bit, float t_exit) const {
    const ContourSlab slab = ContourSlab::make(contour, mirrored_, bit);
    const std::int32_t half = std::int32_t{1} << (bit - 1);
    const Vec3i to_origin{origin_.x - static_cast<std::int32_t>(x) - half,
                          origin_.y - static_cast<std::int32_t>(y) - half,
                          origin_.z - static_cast<std::int32_t>(z) - half};
    const std::int32_t at = dot(slab.normal, to_origin);
    const std::int32_t fall = dot(slab.normal, direction_) | 1;
    const std::int32_t slack = slab.slack(t_exit);
    const float inverse = 2.0f / static_cast<float>(fall);
    const float t_high = static_cast<float>(at - slab.high - slack) * inverse;
    const float t_low = static_cast<float>(at - slab.low + slack) * inverse;
    return fall > 0 ? ContourSpan{t_high, t_low} : ContourSpan{t_low, t_high};
  }

  /// Returns the outward normal, not of unit length, of the plane through which the ray enters.
  VOXDAG_HD Vec3i entered_normal(Contour contour) const {
    const Vec3i n = contour.normal();
    const auto fall = [&](int axis) {
      const std::int32_t f = n[axis] * direction_[axis];
      return (mirrored_ >> axis & 1u) != 0 ? -f : f;
    };
    return fall(0) + fall(1) + fall(2) >= 0 ? n : -n;
  }

 private:
  Vec3i origin_;     ///< Float bits.
  Vec3i direction_;  ///< The ray's direction, negated.
  std::uint32_t mirrored_;
};

}  // namespace voxdag
