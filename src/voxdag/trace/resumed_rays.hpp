#pragma once
/// Casts rays at an ESVO with missing blocks, a part of the way at a time.
///
/// Source: M. Pharr et al., "Rendering Complex Scenes with Memory-Coherent Ray Tracing", SIGGRAPH
/// 1997: rays that reach a missing block wait there. Here a log says for each cast of a pixel where
/// its ray waits, or what it found. The pixel is rendered again and again, with other blocks in
/// memory. Each time the casts of the log that have ended give their results, and the others go on.
/// So a ray needs only one block, with its ancestors, at a time.
#include <cassert>

#include "voxdag/trace/partial_nodes.hpp"
#include "voxdag/trace/scalar_caster.hpp"

namespace voxdag {

/// The log of one pixel's casts, in the order in which the pixel casts them. For one thread.
class RayLog {
 public:
  /// Cast i has the word states[i * stride], for i < most. The first `known` have one already.
  VOXDAG_HD RayLog(std::uint32_t* states, std::uint32_t stride, std::uint32_t known,
                   std::uint32_t most)
      : states_(states), stride_(stride), known_(known), most_(most) {}

  /// Returns the number of casts that have a word.
  VOXDAG_HD std::uint32_t known() const { return known_; }
  /// Returns whether a ray waits for a block.
  VOXDAG_HD bool has_missed() const { return has_missed_; }
  /// Skips the next cast if it has ended, and returns whether it has.
  VOXDAG_HD bool skip_ended() {
    if (next_ >= known_ || !has_ended(state(next_))) return false;
    ++next_;
    return true;
  }

  /// Continues the next cast: returns whether it has met anything. Sets `hit` only in the call in
  /// which the cast ends. If the ray waits for a block, marks it in `wanted` and returns false. If
  /// the further casts of the pixel depend on this one (`decides`), they wait too.
  template <class Stop>
  VOXDAG_HD bool cast(const PartialEsvoView& esvo, std::uint8_t* wanted, const GridRay& ray,
                      const Stop& stop, bool decides, EsvoHit& hit) {
    if (has_stalled_) return false;
    assert(next_ < most_);
    std::uint32_t& word = state(next_++);
    if (next_ > known_) {
      known_ = next_;
      word = bits_of_float(ray.t_min);
    }
    if (has_ended(word)) return word == kHit;
    GridRay rest = ray;
    rest.t_min = float_from_bits(word);
    const bool is_hit = voxdag::cast(ContourNodes(esvo.octree), rest, stop, hit);
    const std::int64_t block = is_hit && would_continue(esvo.octree, rest, stop, hit)
                                   ? esvo.missing_block(hit.voxel.slot)
                                   : -1;
    if (block < 0) {
      word = is_hit ? kHit : kMiss;
      return is_hit;
    }
    begin_at(hit, rest);
    word = bits_of_float(rest.t_min);
    wanted[block] = 1;
    has_missed_ = true;
    has_stalled_ = decides;
    return false;
  }

 private:
  // A word is the float bits of the T from which the ray goes on, or one of these, which are not
  // the bits of a number.
  static constexpr std::uint32_t kHit = 0xFFFFFFFFu, kMiss = 0xFFFFFFFEu;
  VOXDAG_HD static bool has_ended(std::uint32_t word) { return word >= kMiss; }

  VOXDAG_HD std::uint32_t& state(std::uint32_t i) const {
    return states_[static_cast<std::size_t>(i) * stride_];
  }

  std::uint32_t* states_;
  std::uint32_t stride_, known_, most_, next_ = 0;
  bool has_missed_ = false, has_stalled_ = false;
};

/// ContourNodes whose casts go through the log of a pixel.
class ResumedNodes : public ContourNodes {
 public:
  VOXDAG_HD ResumedNodes(const PartialEsvoView& esvo, std::uint8_t* wanted, RayLog& log)
      : ContourNodes(esvo.octree), cut_(esvo.cut), wanted_(wanted), log_(&log) {}

  template <class Stop>
  VOXDAG_HD bool resume(const GridRay& ray, const Stop& stop, bool decides, EsvoHit& hit) const {
    return log_->cast(PartialEsvoView{view(), cut_}, wanted_, ray, stop, decides, hit);
  }

 private:
  const std::uint32_t* cut_;
  std::uint8_t* wanted_;
  RayLog* log_;
};

/// Continues a cast on which the pixel's further casts depend.
template <class Stop>
VOXDAG_HD inline bool cast(const ResumedNodes& nodes, const GridRay& ray, const Stop& stop,
                           EsvoHit& hit) {
  return nodes.resume(ray, stop, true, hit);
}

/// A caster (see trace/scalar_caster.hpp). No further casts may depend on the results of any().
class ResumedCaster : public ScalarCaster<ResumedNodes> {
 public:
  VOXDAG_HD explicit ResumedCaster(const ResumedNodes& nodes)
      : ScalarCaster<ResumedNodes>(nodes), nodes_(nodes) {}

  template <class MakeRay, class OnResult>
  VOXDAG_HD void any(int count, const MakeRay& make_ray, const OnResult& on_result) const {
    for (int i = 0; i < count; ++i) {
      const CastRay& ray = make_ray(i);
      EsvoHit hit;
      on_result(i, nodes_.resume(ray.ray, ray.stop, false, hit));
    }
  }

 private:
  ResumedNodes nodes_;
};

}  // namespace voxdag
