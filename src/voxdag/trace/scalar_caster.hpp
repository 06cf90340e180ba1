#pragma once
/// Casts streams of rays one after the other: the form for one thread of a GPU, and the reference
/// for the wide ones.
///
/// A caster is what the effects of render/ cast their rays with: a type with
///   closest(count, make_ray, on_result)   for the first cell along each ray
///   any(count, make_ray, on_result)       for whether there is one
///   levels()                              L
/// make_ray(i) gives the CastRay i, 0 <= i < count, or a reference to it that outlives the call of
/// the caster; it may be called in any order, once each.
/// on_result(i, ray, cell, is_hit) receives what closest() found, on_result(i, is_hit) what any()
/// did, in any order: what is added up must not depend on it. A cell is a FoundBy<Nodes>::Type. All
/// casters give the same results to the bit.
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/stop_below_size.hpp"

namespace voxdag {

/// A ray with its level of detail; by default to the voxels.
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
