#pragma once
/// The caster of the CPU: sorts a stream of rays into packets of like direction.
#include <algorithm>
#include <utility>

#include "voxdag/cpu/dag_packet.hpp"
#include "voxdag/cpu/esvo_packet.hpp"
#include "voxdag/cpu/ray_window.hpp"

namespace voxdag {

/// A caster (see trace/scalar_caster.hpp) on a BoundedDag, EsvoNodes, ContourNodes or
/// StreamedNodes. Fast where rays that come within thousands of one another are near each other, as
/// those of a tile of a picture are.
template <class Target>
class PacketCaster {
 public:
  explicit PacketCaster(const Target& target) : target_(target) {}

  int levels() const { return target_.levels(); }

  template <class MakeRay, class OnResult>
  void closest(int count, const MakeRay& make_ray, const OnResult& on_result) const {
    run<true>(
        count, make_ray,
        [&](int i, const GridRay& ray, const Hits& hits, std::size_t at) {
          const bool is_hit = hits.is_hit(at);
          on_result(i, ray, is_hit ? hits[at] : Hit{}, is_hit);
        },
        [&](int i, const GridRay& ray) { on_result(i, ray, Hit{}, false); });
  }

  template <class MakeRay, class OnResult>
  void any(int count, const MakeRay& make_ray, const OnResult& on_result) const {
    run<false>(
        count, make_ray,
        [&](int i, const GridRay&, const Hits& hits, std::size_t at) {
          on_result(i, hits.is_hit(at));
        },
        [&](int i, const GridRay&) { on_result(i, false); });
  }

 private:
  using Hits = typename PacketTarget<Target>::Hits;
  using Hit = decltype(std::declval<const Hits&>()[0]);
  /// Whether the target is to be told of hits.
  static constexpr bool kTells =
      requires(const Target& target, const CastRay& ray, const Hit& hit) {
    target.on_hit(ray.ray, ray.stop, hit);
  };

  template <bool kClosest, class MakeRay, class OnCast, class OnMiss>
  void run(int count, const MakeRay& make_ray, const OnCast& on_cast, const OnMiss& on_miss) const {
    RayWindow window;
    RayPacket packet;
    Hits hits;
    for (int first = 0; first < count; first += RayWindow::kMaxRays) {
      window.fill(std::min(RayWindow::kMaxRays, count - first), PacketTarget<Target>::kByDirection,
                  [&](int i) { return make_ray(first + i); });
      if (window.ordered() < window.size())
        for (int i = 0; i < window.size(); ++i)
          if (window[i].ray.misses()) on_miss(first + i, window[i].ray);
      for (int place = 0; place < window.ordered();) {
        const int begin = place;
        const std::uint32_t mirrored = window[window.at(begin)].ray.mirrored;
        packet.size = 0;
        do {
          packet.rays[packet.size++] = &window[window.at(place)];
          ++place;
        } while (place < window.ordered() && packet.size < RayPacket::kMaxRays &&
                 window[window.at(place)].ray.mirrored == mirrored);
        if constexpr (kClosest || kTells)
          cast_packet(target_, packet, hits);
        else
          hits.met = cast_packet_any(target_, packet);
        for (std::size_t at = 0; at < packet.size; ++at) {
          const int i = window.at(begin + static_cast<int>(at));
          if constexpr (kTells)
            if (hits.is_hit(at)) target_.on_hit(window[i].ray, window[i].stop, hits[at]);
          on_cast(first + i, window[i].ray, hits, at);
        }
      }
    }
  }

  Target target_;
};

}  // namespace voxdag
