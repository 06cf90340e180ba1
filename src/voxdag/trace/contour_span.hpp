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
/// without any error in 32 bits, however far the voxel is. The bounds are rounded outwards to these
/// units, d to multiples of 2^-24, and the quotient at last. All is integer but two products that
/// nothing is added to: every machine finds the same T, as for the planes of cubes.
///
/// n.d is made odd, so that it is never 0: a ray along the planes is taken to cross them far away.
///
/// No holes. Let u = 2^-24 and |n| the sum of n's components. d is off by less than 1.25 u for each
/// axis, so T n.d by 1.25 u |n| T, and by another u T where it is made odd; the quotient takes four
/// roundings, which are as good as 4 u |n| T in the numerator; and a cube's T, where the cube ends
/// though the line may not have left it yet, has one, so 2 u |n| T for both of its ends. The planes
/// are moved outwards by 16 u |n| T, T being where the ray leaves the cube: more than all of these
/// together. So a ray whose line meets the exact shape of a voxel it is in meets the voxel, and not
/// just where its range ends, which is no part of it. At a distance of a thousand pixels per radian
/// that is less than 1/500 pixel.
#include "voxdag/layout/contour.hpp"
#include "voxdag/trace/grid_ray.hpp"

namespace voxdag {

/// The T with t_enter <= T < t_leave.
struct ContourSpan {
  float t_enter, t_leave;
};

/// The planes of a contour in a voxel: n.P = low and n.P = high for positions P on them, in units
/// of 2^-23 from the voxel's centre, all mirrored like the rays that they are for.
struct ContourSlab {
  Vec3i normal;
  std::int32_t length1;  ///< Of the normal.
  std::int32_t low, high;

  /// Of a voxel of 1 << bit in units of 2^-23.
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
  /// h position(p) is its steps times 2^(bit - 1) / 127: here 2^22 / 127, then a shift. Both are
  /// rounded down, by less than what the planes are moved outwards; so is slack().
  static constexpr std::int32_t kTopBit = 23, kStep = (1 << 22) / Contour::kMaxPosition;
  static constexpr std::int32_t kWider = 3, kWiderShift = 20;

  /// How far the planes are moved outwards for a ray that leaves the cube at t_exit: of 16 u |n| T
  /// the whole units.
  VOXDAG_HD std::int32_t slack(float t_exit) const {
    // The float next to 8192 that is t_exit above it, for t_exit up to 1, counts 1024ths.
    const std::uint32_t reach = bits_of_float(t_exit + kReachBase) - bits_of_float(kReachBase);
    return length1 * (static_cast<std::int32_t>(reach) + 1) >> kReachShift;
  }
  static constexpr float kReachBase = 8192.0f;
  static constexpr int kReachShift = 7;
};

/// A ray as contours see it, mirrored.
class ContourRay {
 public:
  VOXDAG_HD explicit ContourRay(const GridRay& ray) : mirrored_(ray.mirrored) {
    for (int axis = 0; axis < 3; ++axis) {
      origin_[axis] = static_cast<std::int32_t>(bits_of_float(ray.origin[axis]));
      direction_[axis] = direction(ray.inverse[axis]);
    }
  }

  /// How fast a ray falls along an axis, in 2^-24; 0 along parallel axes.
  VOXDAG_HD static std::int32_t direction(float inverse) {
    return static_cast<std::int32_t>(kDirectionOne / inverse);
  }
  static constexpr float kDirectionOne = 0x1p24f;

  /// Of the voxel with its lower corner at the float bits (x,y,z), of 1 << bit in units of 2^-23,
  /// which the ray leaves at `t_exit`.
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

  /// The outward normal, not of unit length, of the plane by which the ray comes between the two.
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
  Vec3i direction_;  ///< Minus that of the ray.
  std::uint32_t mirrored_;
};

}  // namespace voxdag
