#pragma once
/// The caster of the CPU for ESVOs: sorts a stream of rays into packets of like direction.
#include <type_traits>

#include "voxdag/cpu/esvo_packet.hpp"

namespace voxdag {

/// A caster (see trace/scalar_caster.hpp) on EsvoNodes or ContourNodes. Fast where rays that follow
/// one another are near each other, as those of neighbouring pixels or of one surface point are.
template <class Nodes>
class EsvoPacketCaster {
 public:
  explicit EsvoPacketCaster(const Nodes& nodes) : nodes_(nodes) {}

  int levels() const { return nodes_.levels(); }

  template <class MakeRay, class OnResult>
  void closest(int count, const MakeRay& make_ray, const OnResult& on_result) const {
    GridRay rays[kOctants][RayPacket::kMaxRays];
    run(
        count, make_ray,
        [&](std::size_t octant, std::size_t at, const GridRay& ray) { rays[octant][at] = ray; },
        [&](int i, const GridRay& ray) { on_result(i, ray, EsvoHit{}, false); },
        [&](std::size_t octant, const EsvoPacket& packet, const int* ids, std::uint64_t hits) {
          for (std::size_t at = 0; at < packet.size; ++at) {
            const bool is_hit = (hits >> at & 1u) != 0;
            on_result(ids[at], rays[octant][at], is_hit ? packet.hit(at) : EsvoHit{}, is_hit);
          }
        });
  }

  template <class MakeRay, class OnResult>
  void any(int count, const MakeRay& make_ray, const OnResult& on_result) const {
    run(
        count, make_ray, [](std::size_t, std::size_t, const GridRay&) {},
        [&](int i, const GridRay&) { on_result(i, false); },
        [&](std::size_t, const EsvoPacket& packet, const int* ids, std::uint64_t hits) {
          for (std::size_t at = 0; at < packet.size; ++at)
            on_result(ids[at], (hits >> at & 1u) != 0);
        });
  }

 private:
  static constexpr std::size_t kOctants = 8;

  template <class MakeRay, class OnAdd, class OnMiss, class OnCast>
  void run(int count, const MakeRay& make_ray, const OnAdd& on_add, const OnMiss& on_miss,
           const OnCast& on_cast) const {
    EsvoPacket packets[kOctants];
    int ids[kOctants][RayPacket::kMaxRays];
    const auto flush = [&](std::size_t octant) {
      EsvoPacket& packet = packets[octant];
      on_cast(octant, packet, ids[octant], cast_packet(nodes_, packet));
      packet.clear();
    };
    for (int i = 0; i < count; ++i) {
      const CastRay ray = make_ray(i);
      if (ray.ray.misses()) {
        on_miss(i, ray.ray);
        continue;
      }
      EsvoPacket& packet = packets[ray.ray.mirrored];
      ids[ray.ray.mirrored][packet.size] = i;
      on_add(ray.ray.mirrored, packet.size, ray.ray);
      packet.add(ray);
      if (packet.size == RayPacket::kMaxRays) flush(ray.ray.mirrored);
    }
    for (std::size_t octant = 0; octant < kOctants; ++octant)
      if (packets[octant].size > 0) flush(octant);
  }

  Nodes nodes_;
};

}  // namespace voxdag
