#pragma once
/// A normal block: sixteen normals in 128 bits.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 3.5. A normal is
/// one of the 4x4 points of a grid, base + cu u_axis + cv v_axis with cu and cv in {-1, -1/3, 1/3,
/// 1}, normalised.
///
///   word 0   the base, a point of the cube [-1,1]³:
///              bits 31..29  face: 2 axis + (1 if the coordinate of that axis is -1, not 1);
///                           6 and 7 are unused; readers take them for 4 and 5
///              bits 28..14  U: the coordinate of axis + 1 (mod 3) is (U - 16384) / 16383
///              bits 13..0   V: the coordinate of axis + 2 (mod 3) is (V - 8192) / 8191
///   word 1   bits 15..0     the u axis: x 3..0, y 7..4, z 11..8 in two's complement and
///                           e 15..12; the vector is (x, y, z) 2^(e - 16)
///            bits 31..16    the v axis in the same form
///   word 2   the steps of cu, 2 bits per value, those of value i at bit 2i: k means (2k - 3) / 3
///   word 3   the steps of cv in the same form
///
/// The coordinates 0, 1 and -1 are exact, so the normals of axis-aligned and diagonal walls are
/// exact too. Every direction has a base within 0.004 degrees. Axes have steps from 2^-16 up and
/// lengths up to 4: twice the length that a grid needs to hold a direction and its opposite.
#include <cassert>
#include <cmath>
#include <cstdint>
#include <type_traits>

#include "voxdag/core/bits.hpp"
#include "voxdag/core/vec.hpp"
#include "voxdag/stored/attributes/attribute_values.hpp"

namespace voxdag {

/// A point on the surface of the cube [-1,1]³, in steps of U and V. A U or V of 0 is just outside
/// the cube: readers accept it, writers never write it.
struct CubePoint {
  int face = 0;   ///< [0, 6)
  int u = 16384;  ///< [0, 32768)
  int v = 8192;   ///< [0, 16384)

  VOXDAG_HD constexpr std::uint32_t pack() const {
    assert(face >= 0 && face < 6 && u >= 0 && u < 32768 && v >= 0 && v < 16384);
    return static_cast<std::uint32_t>(face) << 29 | static_cast<std::uint32_t>(u) << 14 |
           static_cast<std::uint32_t>(v);
  }
  VOXDAG_HD static constexpr CubePoint unpack(std::uint32_t bits) {
    const int face = static_cast<int>(bits >> 29);
    return {face < 6 ? face : face - 2, static_cast<int>(bits >> 14 & 0x7FFFu),
            static_cast<int>(bits & 0x3FFFu)};
  }

  VOXDAG_HD constexpr Vec3f position() const {
    const float w = (face & 1) != 0 ? -1.0f : 1.0f;
    const float pu = static_cast<float>(u - 16384) / 16383.0f;
    const float pv = static_cast<float>(v - 8192) / 8191.0f;
    return face < 2 ? Vec3f{w, pu, pv} : face < 4 ? Vec3f{pv, w, pu} : Vec3f{pu, pv, w};
  }
  friend bool operator==(const CubePoint&, const CubePoint&) = default;
};

/// A vector of three small integers, times a power of two.
struct GridAxis {
  int x = 0, y = 0, z = 0;  ///< [-8, 7]
  int exponent = 0;         ///< [0, 15]

  static constexpr int kBias = 16;

  VOXDAG_HD constexpr std::uint32_t pack() const {
    assert(x >= -8 && x < 8 && y >= -8 && y < 8 && z >= -8 && z < 8);
    assert(exponent >= 0 && exponent < 16);
    return static_cast<std::uint32_t>((x & 15) | (y & 15) << 4 | (z & 15) << 8 | exponent << 12);
  }
  /// Reads the low 16 bits.
  VOXDAG_HD static constexpr GridAxis unpack(std::uint32_t bits) {
    const auto component = [bits](int shift) {
      return static_cast<int>((bits >> shift & 15u) ^ 8u) - 8;
    };
    return {component(0), component(4), component(8), static_cast<int>(bits >> 12 & 15u)};
  }

  VOXDAG_HD Vec3f vector() const {
    return Vec3f{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)} *
           scale(exponent);
  }
  /// Returns 2^(exponent - 16).
  VOXDAG_HD static float scale(int exponent) {
    return float_from_bits(static_cast<std::uint32_t>(127 + exponent - kBias) << 23);
  }
  friend bool operator==(const GridAxis&, const GridAxis&) = default;
};

struct NormalBlock {
  std::uint32_t words[4] = {};

  /// Packs a block; `u_steps` and `v_steps` are the contents of words 2 and 3.
  VOXDAG_HD static constexpr NormalBlock pack(CubePoint base, GridAxis u_axis, GridAxis v_axis,
                                              std::uint32_t u_steps, std::uint32_t v_steps) {
    return {{base.pack(), u_axis.pack() | v_axis.pack() << 16, u_steps, v_steps}};
  }

  VOXDAG_HD constexpr CubePoint base() const { return CubePoint::unpack(words[0]); }
  VOXDAG_HD constexpr GridAxis u_axis() const { return GridAxis::unpack(words[1] & 0xFFFFu); }
  VOXDAG_HD constexpr GridAxis v_axis() const { return GridAxis::unpack(words[1] >> 16); }
  /// Returns the step, 0 to 3, of value `index` in [0, 16) along the u axis.
  VOXDAG_HD constexpr int u_step(int index) const { return step(words[2], index); }
  VOXDAG_HD constexpr int v_step(int index) const { return step(words[3], index); }

  /// Returns base + cu u + cv v, not normalised, for the steps of cu and cv.
  VOXDAG_HD static Vec3f grid_point(Vec3f base, Vec3f u, Vec3f v, int u_step, int v_step) {
    const float cu = static_cast<float>(2 * u_step - 3) / 3.0f;
    const float cv = static_cast<float>(2 * v_step - 3) / 3.0f;
    return base + u * cu + v * cv;
  }

  /// Returns value `index` in [0, 16), of unit length. If the grid's point is too close to zero to
  /// have a direction, returns the direction of the base.
  VOXDAG_HD Vec3f normal(int index) const {
    const Vec3f base_point = base().position();
    Vec3f n =
        grid_point(base_point, u_axis().vector(), v_axis().vector(), u_step(index), v_step(index));
    float squared = dot(n, n);
    if (squared < 1e-12f) {
      n = base_point;
      squared = dot(n, n);
    }
    return n * (1.0f / std::sqrt(squared));
  }
  friend bool operator==(const NormalBlock&, const NormalBlock&) = default;

 private:
  VOXDAG_HD static constexpr int step(std::uint32_t steps, int index) {
    assert(index >= 0 && index < kValuesPerBlock);
    return static_cast<int>(steps >> (2 * index) & 3u);
  }
};

static_assert(sizeof(NormalBlock) == 16 && alignof(NormalBlock) == 4 &&
              std::is_trivially_copyable_v<NormalBlock>);

}  // namespace voxdag
