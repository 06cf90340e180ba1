#pragma once
/// Wraps any of voxdag's casters as a runner of `voxdag bench`.
#include <span>

#include "lab/rays/trace_rays.hpp"
#include "lab/rays/trace_runner.hpp"

namespace voxdag::lab {

/// Returns a runner for any caster (see trace/scalar_caster.hpp). `casts` must outlive it.
template <class Caster>
TraceRunner runner_of(const Caster& caster, RayClass rays, std::span<const CastRay> casts) {
  TraceRunner runner;
  runner.name = "voxdag";
  runner.cast = [caster, casts, closest = is_closest(rays)](std::size_t first, std::size_t last,
                                                            std::uint8_t* hits) {
    const auto count = static_cast<int>(last - first);
    const auto make_ray = [rays = casts.data() + first](int i) -> const CastRay& {
      return rays[i];
    };
    const auto set = [out = hits + first](int i, bool is_hit) {
      out[i] = static_cast<std::uint8_t>(is_hit);
    };
    if (closest)
      caster.closest(count, make_ray,
                     [set](int i, const GridRay&, const CellHit&, bool is_hit) { set(i, is_hit); });
    else
      caster.any(count, make_ray, set);
  };
  return runner;
}

}  // namespace voxdag::lab
