#pragma once
/// Level of detail: ends a cast at cells that are too small to matter at their distance.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 4.1: compares the
/// size of the cell with a linear function of t.
#include <cstdint>

#include "voxdag/core/bits.hpp"
#include "voxdag/trace/grid_ray.hpp"

namespace voxdag {

/// A termination hook for cast(): true for cells of level `coarsest_level` or finer whose side is
/// at most at_start + per_t * T, where T is the ray's exit from the cell. Unlike the entry, the
/// exit does not depend on where the ray starts, so shortened rays end at the same cells. Sides are
/// in units of the grid's side: a cell of level l has the side 2^-l.
struct StopBelowSize {
  float at_start = 0;
  float per_t = 0;
  int coarsest_level = 2;

  VOXDAG_HD bool operator()(int level, float /*t_enter*/, float t_exit) const {
    const float side = float_from_bits(static_cast<std::uint32_t>(127 - level) << 23);
    return level >= coarsest_level && side <= at_start + per_t * t_exit;
  }

  /// Returns a level such that the hook is false at all coarser levels (with lower numbers). Uses
  /// that T is at most 1 in the grid.
  VOXDAG_HD int first_level() const {
    const float most = (at_start + (per_t > 0 ? per_t : 0)) * (1 + 0x1p-10f);
    const int level = most > 0 ? 127 - static_cast<int>(bits_of_float(most) >> 23) : 127;
    return level > coarsest_level ? level : coarsest_level;
  }
};

/// Returns the hook that ends the cast of `ray` at cells whose side is at most `size_per_t` * t, in
/// world units: the footprint of a pixel, seen from the ray's origin at t = 0.
VOXDAG_HD inline StopBelowSize stop_below_size(const Grid& grid, const GridRay& ray,
                                               double size_per_t) {
  const double scale = size_per_t / grid.side();
  StopBelowSize stop;
  stop.at_start = static_cast<float>(scale * ray.t_start);
  stop.per_t = static_cast<float>(scale * ray.t_scale);
  return stop;
}

}  // namespace voxdag
