#pragma once
/// The caster of the CPU: divides a stream of rays into packets of similar direction.
#include <algorithm>
#include <utility>

#include "voxdag/cpu/packets/dag_packet.hpp"
#include "voxdag/cpu/packets/esvo_packet.hpp"
#include "voxdag/cpu/packets/ray_window.hpp"

namespace voxdag {

/// A caster (see trace/scalar_caster.hpp) at a BoundedDag, InPlaceDag, EsvoNodes, ContourNodes or
/// StreamedNodes. It is fast if rays within a few thousand places in the stream are also near each
/// other in space, like the rays of a tile of a picture.
template <class Target>
class PacketCaster {
 public:
  explicit PacketCaster(const Target& target) : target_(target) {}

  int levels() const { return target_.levels(); }

  template <class MakeRay, class OnResult>
  void closest(int count, const MakeRay& make_ray, const OnResult& on_result) const {
    run<true>(
        count, make_ray,
        [&](int i, const GridRay& ray, const Hits& hits, std::size_t at, bool is_hit) {
          on_result(i, ray, is_hit ? hits[at] : Hit{}, is_hit);
        },
        [&](int i, const GridRay& ray) { on_result(i, ray, Hit{}, false); });
  }

  template <class MakeRay, class OnResult>
  void any(int count, const MakeRay& make_ray, const OnResult& on_result) const {
    run<false>(
        count, make_ray,
        [&](int i, const GridRay&, const Hits&, std::size_t, bool is_hit) { on_result(i, is_hit); },
        [&](int i, const GridRay&) { on_result(i, false); });
  }

 private:
  using Hits = typename PacketTarget<Target>::Hits;
  using Hit = decltype(std::declval<const Hits&>()[0]);
  /// Whether the target must be told about hits.
  static constexpr bool kTells =
      requires(const Target& target, const CastRay& ray, const Hit& hit) {
    target.on_hit(ray.ray, ray.stop, hit);
  };

  template <bool kClosest, class MakeRay, class OnCast, class OnMiss>
  void run(int count, const MakeRay& make_ray, const OnCast& on_cast, const OnMiss& on_miss) const {
    RayWindow window;
    RayPacket packet;
    Hits hits;
    for (int first = 0; first < count; first += window.taken()) {
      window.fill(
          count - first, PacketTarget<Target>::kByDirection,
          [&](int i) -> decltype(auto) { return make_ray(first + i); },
          [&](int i, const GridRay& ray) { on_miss(first + i, ray); });
      for (int place = 0; place < window.size();) {
        window.set_packet(place, packet);
        if constexpr (kClosest || kTells)
          cast_packet(target_, packet, hits);
        else
          hits.met = cast_packet_any(target_, packet);
        // Copies the values, so that the compiler knows that writing results does not change them.
        const std::size_t size = packet.size;
        const std::uint64_t met = hits.met;
        for (std::size_t at = 0; at < size; ++at, ++place) {
          const CastRay& ray = *packet.rays[at];
          const bool is_hit = (met >> at & 1u) != 0;
          if constexpr (kTells)
            if (is_hit) target_.on_hit(ray.ray, ray.stop, hits[at]);
          on_cast(first + window.index(place), ray.ray, hits, at, is_hit);
        }
      }
    }
  }

  Target target_;
};

}  // namespace voxdag
