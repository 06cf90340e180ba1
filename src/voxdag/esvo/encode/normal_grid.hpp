#pragma once
/// A grid of normals in the making: which normals it is for, how near it comes to them, and the
/// nearest stored forms of its parts.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "voxdag/core/lanes.hpp"
#include "voxdag/layout/normal_block.hpp"

namespace voxdag {

/// A block's used normals, those that differ by next to nothing as one. What lies past `count` has
/// no weight.
struct NormalValues {
  std::size_t count = 0;
  float total_weight = 0.0f;
  std::uint32_t used = 0;                ///< slots with a direction
  std::size_t of_slot[kValuesPerBlock];  ///< which of the normals a used slot has
  Vec3f normal[kValuesPerBlock];         ///< of unit length
  float weight[kValuesPerBlock] = {};
  float x[kValuesPerBlock] = {}, y[kValuesPerBlock] = {}, z[kValuesPerBlock] = {};
};

/// Fills `values`, which must be new.
void gather_normals(std::span<const Vec3f, kValuesPerBlock> normals, std::uint32_t used,
                    const float* weights, NormalValues& values);

/// A grid of real numbers.
struct RealGrid {
  Vec3f base, u, v;
};

/// A grid, the point of it that each normal takes, and what that costs.
struct NormalFit {
  CubePoint base;
  GridAxis u, v;
  float cu[kValuesPerBlock], cv[kValuesPerBlock];  ///< of {-1, -1/3, 1/3, 1}
  float error;                                     ///< weighted sum of squared chords

  RealGrid grid() const { return {base.position(), u.vector(), v.vector()}; }
};

/// Gives each normal the nearest point of the grid, and the fit its error.
void fit_points(const NormalValues& values, NormalFit& fit);

inline Vec3f unit_vector(Vec3f v) { return v * (1.0f / std::sqrt(dot(v, v))); }
/// The greatest of the components' sizes.
float longest_side(Vec3f v);

/// The point of the cube nearest to a direction of any length but zero.
CubePoint nearest_cube_point(Vec3f direction);

/// The stored axis nearest to `target` as seen along `base`, a unit vector: components along the
/// base only lengthen a grid's normals, and to let them be anything makes the others finer.
/// `bend` is what a squared unit of them costs in squared units of the error across.
GridAxis nearest_axis(Vec3f target, Vec3f base, float bend);

}  // namespace voxdag
