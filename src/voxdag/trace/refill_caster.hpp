#pragma once
/// Casts the rays of a stream at a DAG with a dense grid, for a GPU whose threads run in warps.
///
/// Rays in all directions take different numbers of steps, and a warp that casts one per thread
/// takes as many as its longest ray. So a thread whose ray has ended starts its next one while
/// others continue. One start takes a warp as long as 32, so threads wait until some can start
/// together.
///
/// Source: Aila and Laine, "Understanding the Efficiency of Ray Traversal on GPUs", HPG 2009.
#include "voxdag/trace/scalar_caster.hpp"
#include "voxdag/trace/top_cast.hpp"

namespace voxdag {

/// The threads of a warp that run together; on the host this one alone.
class WarpLanes {
 public:
  /// Returns how many of the lanes have `is`. All of them must call it.
  VOXDAG_HD int count(bool is) const {
#ifdef __CUDA_ARCH__
    return __popc(__ballot_sync(lanes_, is));
#else
    return is ? 1 : 0;
#endif
  }

#ifdef __CUDA_ARCH__
 private:
  unsigned lanes_ = __activemask();
#endif
};

/// A caster as scalar_caster.hpp defines it. Only any() starts rays at different times. any() makes
/// a `Lanes`, which is as WarpLanes.
template <class Lanes = WarpLanes>
class RefillCaster : public ScalarCaster<TopNodes> {
 public:
  /// Threads start their next rays when so many of them wait, or when none of the lanes runs.
  static constexpr int kStartTogether = 8;

  VOXDAG_HD explicit RefillCaster(const TopNodes& nodes)
      : ScalarCaster<TopNodes>(nodes), nodes_(nodes) {}

  template <class MakeRay, class OnResult>
  VOXDAG_HD void any(int count, const MakeRay& make_ray, const OnResult& on_result) const {
    const Lanes lanes;
    TopWalk::Entry stack[kMaxLevels];
    TopWalk walk;
    CastRay ray;
    CellHit cell;
    bool runs = false;
    for (int next = 0, current = 0;;) {
      const int running = lanes.count(runs);
      const int waiting = lanes.count(!runs && next < count);
      if (running == 0 && waiting == 0) return;
      if (!runs && next < count && (running == 0 || waiting >= kStartTogether)) {
        current = next++;
        ray = make_ray(current);
        runs = can_walk(nodes_, ray.ray);
        if (runs)
          walk = TopWalk(nodes_, ray.ray, ray.stop.first_level());
        else
          on_result(current, false);
      }
      if (!runs) continue;
      const TopWalk::State state = walk.step(nodes_, ray.ray, ray.stop, stack, cell);
      if (state == TopWalk::State::kRuns) continue;
      runs = false;
      on_result(current, state == TopWalk::State::kHits);
    }
  }

 private:
  TopNodes nodes_;
};

}  // namespace voxdag
