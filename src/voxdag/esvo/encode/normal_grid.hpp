#pragma once
/// A grid of normals under construction: its normals, its error, and the nearest stored forms of
/// its parts.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "voxdag/core/lanes.hpp"
#include "voxdag/layout/normal_block.hpp"

namespace voxdag {

/// The used normals of a block; nearly equal ones are one. Entries after `count` have weight 0.
struct NormalValues {
  std::size_t count = 0;
  float total_weight = 0.0f;
  std::uint32_t used = 0;                ///< slots with a direction
  std::size_t of_slot[kValuesPerBlock];  ///< index of a used slot's normal
  Vec3f normal[kValuesPerBlock];         ///< of unit length
  float weight[kValuesPerBlock] = {};
  float x[kValuesPerBlock] = {}, y[kValuesPerBlock] = {}, z[kValuesPerBlock] = {};
};

/// Collects the used normals in `values`, which must be new.
void gather_normals(std::span<const Vec3f, kValuesPerBlock> normals, std::uint32_t used,
                    const float* weights, NormalValues& values);

/// A grid of real numbers.
struct RealGrid {
  Vec3f base, u, v;
};

/// A grid in its stored form, the grid point of each normal, and the error.
struct NormalFit {
  CubePoint base;
  GridAxis u, v;
  float cu[kValuesPerBlock], cv[kValuesPerBlock];  ///< of {-1, -1/3, 1/3, 1}
  float error;                                     ///< weighted sum of squared chords

  RealGrid grid() const { return {base.position(), u.vector(), v.vector()}; }
};

/// Assigns the nearest grid point to each normal, and sets the error.
void fit_points(const NormalValues& values, NormalFit& fit);

inline Vec3f unit_vector(Vec3f v) { return v * (1.0f / std::sqrt(dot(v, v))); }
/// Returns the largest absolute value of a component.
float longest_side(Vec3f v);

/// Returns the point of the cube nearest to a direction, which may have any length but zero.
CubePoint nearest_cube_point(Vec3f direction);

/// Returns the stored axis nearest to `target` as seen along `base`, a unit vector. Components
/// along the base only change the length of a grid's normals, so they are nearly free, which makes
/// the others finer. `bend` is the cost of a squared unit along the base, in squared units across
/// it.
GridAxis nearest_axis(Vec3f target, Vec3f base, float bend);

}  // namespace voxdag
