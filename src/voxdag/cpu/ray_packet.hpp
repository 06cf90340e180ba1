#pragma once
/// Rays of like direction that are cast together.
#include <cstddef>
#include <cstdint>

#include "voxdag/trace/scalar_caster.hpp"

namespace voxdag {

/// Up to 64 rays that are mirrored alike, and what they met. Arrays are by axis, then by ray.
struct RayPacket {
  static constexpr std::size_t kMaxRays = 64;

  alignas(64) float origin[3][kMaxRays], inverse[3][kMaxRays];
  alignas(64) float t_min[kMaxRays];
  /// The next float after t_max: a cell is met if it is entered before that.
  alignas(64) float t_end[kMaxRays];
  alignas(64) float stop_start[kMaxRays], stop_per_t[kMaxRays];
  std::uint32_t cell[kMaxRays][3];  ///< Of rays that met one: the float bits of its lower corner.
  int level[kMaxRays];              ///< Likewise.
  std::size_t size = 0;
  std::uint32_t mirrored = 0;
  int coarsest = 2;  ///< Of the rays' levels of detail, which must agree in it.
  bool has_stop = false;

  void clear() {
    size = 0;
    has_stop = false;
  }

  /// Adds a ray with misses() false; the packet must not be full and its rays be mirrored like it.
  void add(const CastRay& cast_ray) {
    const GridRay& ray = cast_ray.ray;
    const std::size_t i = size++;
    mirrored = ray.mirrored;
    for (int axis = 0; axis < 3; ++axis) {
      origin[axis][i] = ray.origin[axis];
      inverse[axis][i] = ray.inverse[axis];
    }
    t_min[i] = ray.t_min;
    t_end[i] = ray.t_max < HUGE_VALF ? float_from_bits(bits_of_float(ray.t_max) + 1) : ray.t_max;
    stop_start[i] = cast_ray.stop.at_start;
    stop_per_t[i] = cast_ray.stop.per_t;
    coarsest = cast_ray.stop.coarsest_level;
    has_stop |= cast_ray.stop.at_start > 0 || cast_ray.stop.per_t > 0;
  }
};

}  // namespace voxdag
