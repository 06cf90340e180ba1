#pragma once
/// Casts the rays of a stream one at a time: the caster for a GPU thread, and the reference for the
/// packet casters.
///
/// The effects of render/ cast their rays through a caster, a type with
///   closest(count, make_ray, on_result)   finds the first cell along each ray
///   any(count, make_ray, on_result)       finds whether there is one
///   levels()                              returns L
/// make_ray(i) returns CastRay i, 0 <= i < count, or a reference to it that outlives the call of
/// the caster. It is called once for each i, in any order. closest() calls on_result(i, ray, cell,
/// is_hit), any() calls on_result(i, is_hit), in any order: sums over results must not depend on
/// the order. A cell is a FoundBy<Nodes>::Type. All casters give the same results, to the bit.
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/stop_below_size.hpp"

namespace voxdag {

/// A ray with its level of detail; by default it ends at voxels.
struct CastRay {
  GridRay ray;
  StopBelowSize stop;
};

template <class Nodes>
class ScalarCaster {
 public:
  VOXDAG_HD explicit ScalarCaster(const Nodes& nodes) : nodes_(nodes) {}

  VOXDAG_HD int levels() const { return nodes_.levels(); }

  template <class MakeRay, class OnResult>
  VOXDAG_HD void closest(int count, const MakeRay& make_ray, const OnResult& on_result) const {
    for (int i = 0; i < count; ++i) {
      const CastRay& ray = make_ray(i);
      typename FoundBy<Nodes>::Type cell;
      const bool is_hit = cast(nodes_, ray.ray, ray.stop, cell);
      on_result(i, ray.ray, cell, is_hit);
    }
  }

  template <class MakeRay, class OnResult>
  VOXDAG_HD void any(int count, const MakeRay& make_ray, const OnResult& on_result) const {
    for (int i = 0; i < count; ++i) {
      const CastRay& ray = make_ray(i);
      typename FoundBy<Nodes>::Type cell;
      on_result(i, cast(nodes_, ray.ray, ray.stop, cell));
    }
  }

 private:
  Nodes nodes_;
};

}  // namespace voxdag
