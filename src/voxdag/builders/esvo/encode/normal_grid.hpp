#pragma once
/// The data of fitting a grid to normals: the normals, a grid, its error, and rounding of a grid to
/// its stored form.
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>

#include "voxdag/core/lanes.hpp"
#include "voxdag/stored/esvo/normal_block.hpp"

namespace voxdag {

/// The used normals of a block; nearly equal ones are merged. Entries past `count` have weight 0.
///
struct NormalValues {
  std::size_t count = 0;
  float total_weight = 0.0f;
  std::uint32_t used = 0;                ///< slots with a direction
  std::size_t of_slot[kValuesPerBlock];  ///< index of a used slot's normal
  Vec3f normal[kValuesPerBlock];         ///< of unit length
  float weight[kValuesPerBlock] = {};
  float x[kValuesPerBlock] = {}, y[kValuesPerBlock] = {}, z[kValuesPerBlock] = {};
};

/// Collects the used normals in `values`, which must be empty.
void gather_normals(std::span<const Vec3f, kValuesPerBlock> normals, std::uint32_t used,
                    const float* weights, NormalValues& values);

/// A grid of real numbers.
struct RealGrid {
  Vec3f base, u, v;
};

/// A grid, the grid point assigned to each normal, and the error.
struct NormalFit {
  CubePoint base;
  GridAxis u, v;
  float cu[kValuesPerBlock], cv[kValuesPerBlock];  ///< of {-1, -1/3, 1/3, 1}
  float error;                                     ///< weighted sum of squared chords

  RealGrid grid() const { return {base.position(), u.vector(), v.vector()}; }
};

/// Assigns the nearest grid point to each normal and sets the error of the fit.
void fit_points(const NormalValues& values, NormalFit& fit);

inline Vec3f unit_vector(Vec3f v) { return v * (1.0f / std::sqrt(dot(v, v))); }
/// Returns the largest absolute value of the components.
float longest_side(Vec3f v);

/// Returns the stored cube point nearest to a direction, which is not zero.
CubePoint nearest_cube_point(Vec3f direction);

/// Returns the stored axis nearest to `target`, seen along the unit vector `base`. A component
/// along the base only makes the grid's normals longer, so it may have an error; that allows finer
/// steps of the other components. `bend` is the cost of the squared error along the base, relative
/// to the squared error across it.
GridAxis nearest_axis(Vec3f target, Vec3f base, float bend);

}  // namespace voxdag
