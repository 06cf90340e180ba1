#pragma once
/// Casts the rays of a stream at a DAG with a dense grid, for a GPU whose threads run in warps.
///
/// Rays in all directions take different numbers of steps, and a warp that casts one per thread
/// takes as many as its longest ray: three times the mean of occlusion rays. So a thread whose ray
/// has ended takes its next one while the others continue. Starting rays takes as long for one
/// thread as for all, so threads wait until some of them have ended.
///
/// Source: Aila and Laine, "Understanding the Efficiency of Ray Traversal on GPUs", HPG 2009.
#include "voxdag/trace/scalar_caster.hpp"
#include "voxdag/trace/top_cast.hpp"

namespace voxdag {

/// The threads of the warp that run together with this one, as bits; on the host this one alone.
VOXDAG_HD inline unsigned lanes_together() {
#ifdef __CUDA_ARCH__
  return __activemask();
#else
  return 1u;
#endif
}

/// Returns how many of `lanes` have `is`; all of them must call it.
VOXDAG_HD inline int count_lanes(unsigned lanes, bool is) {
#ifdef __CUDA_ARCH__
  return __popc(__ballot_sync(lanes, is));
#else
  return is ? static_cast<int>(lanes) : 0;
#endif
}

/// A caster as scalar_caster.hpp defines it. Only any() starts rays at different times.
class RefillCaster : public ScalarCaster<TopNodes> {
 public:
  /// The number of threads that wait until they start their next rays together.
  static constexpr int kStartTogether = 8;

  VOXDAG_HD explicit RefillCaster(const TopNodes& nodes)
      : ScalarCaster<TopNodes>(nodes), nodes_(nodes) {}

  template <class MakeRay, class OnResult>
  VOXDAG_HD void any(int count, const MakeRay& make_ray, const OnResult& on_result) const {
    const unsigned lanes = lanes_together();
    TopWalk::Entry stack[kMaxLevels];
    TopWalk walk;
    CastRay ray;
    CellHit cell;
    bool runs = false;
    for (int next = 0, current = 0;;) {
      const int running = count_lanes(lanes, runs);
      const int waiting = count_lanes(lanes, !runs && next < count);
      if (running == 0 && waiting == 0) return;
      if (!runs && next < count && (running == 0 || waiting >= kStartTogether)) {
        current = next++;
        ray = make_ray(current);
        runs = can_hit(nodes_, ray.ray);
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
