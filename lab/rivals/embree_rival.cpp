/// Embree 3 casts rays at triangles.
#include "lab/rivals/embree_rival.hpp"

#if VOXDAG_HAS_EMBREE

#include <algorithm>
#include <cmath>

#include "voxdag/mesh_view/embree_scene.hpp"

namespace voxdag::lab {
/// A value with the alignment that RTCRayHit16 and RTCRay16 need.
template <class T>
struct alignas(64) AlignedPacket {
  T value;
};

namespace {

constexpr std::size_t kPacket = 16;

RTCIntersectContext context(bool is_coherent) {
  RTCIntersectContext result;
  rtcInitIntersectContext(&result);
  result.flags =
      is_coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return result;
}

RTCRay embree_ray(const Grid& grid, const EmbreeScene& scene, const GridRay& cast) {
  const WorldRay world = to_world_ray(grid, cast);
  const Vec3f o = static_cast<Vec3f>(scene.from_world(world.origin));
  const Vec3f d = static_cast<Vec3f>(world.direction * scene.scale());
  RTCRay ray{};
  ray.org_x = o.x;
  ray.org_y = o.y;
  ray.org_z = o.z;
  ray.dir_x = d.x;
  ray.dir_y = d.y;
  ray.dir_z = d.z;
  ray.tnear = world.t_min;
  ray.tfar = world.t_max;
  ray.mask = ~0u;
  return ray;
}

void set_lane(RTCRay16& packet, std::size_t lane, const RTCRay& ray) {
  packet.org_x[lane] = ray.org_x;
  packet.org_y[lane] = ray.org_y;
  packet.org_z[lane] = ray.org_z;
  packet.dir_x[lane] = ray.dir_x;
  packet.dir_y[lane] = ray.dir_y;
  packet.dir_z[lane] = ray.dir_z;
  packet.tnear[lane] = ray.tnear;
  packet.tfar[lane] = ray.tfar;
  packet.time[lane] = ray.time;
  packet.mask[lane] = ray.mask;
  packet.id[lane] = ray.id;
  packet.flags[lane] = ray.flags;
}

}  // namespace

class EmbreeRival::Scene {
 public:
  explicit Scene(Mesh mesh) : embree_(std::move(mesh), EmbreeMode::kFast) {}

  void convert(const Grid& grid, std::span<const CastRay> casts) {
    singles_.resize(casts.size());
    packets_.resize((casts.size() + kPacket - 1) / kPacket);
    for (std::size_t i = 0; i < casts.size(); ++i) {
      singles_[i] = embree_ray(grid, embree_, casts[i].ray);
      set_lane(packets_[i / kPacket].value, i % kPacket, singles_[i]);
    }
  }

  float closest_t(std::size_t i) const {
    RTCIntersectContext ctx = context(false);
    RTCRayHit query{};
    query.ray = singles_[i];
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(embree_.scene(), &ctx, &query);
    return query.hit.geomID != RTC_INVALID_GEOMETRY_ID ? query.ray.tfar : HUGE_VALF;
  }

  void cast_single(bool is_closest, std::size_t first, std::size_t last, std::uint8_t* hits) const {
    RTCIntersectContext ctx = context(false);
    for (std::size_t i = first; i < last; ++i) {
      if (is_closest) {
        RTCRayHit query{};
        query.ray = singles_[i];
        query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(embree_.scene(), &ctx, &query);
        hits[i] = query.hit.geomID != RTC_INVALID_GEOMETRY_ID ? 1 : 0;
      } else {
        RTCRay ray = singles_[i];
        rtcOccluded1(embree_.scene(), &ctx, &ray);
        hits[i] = ray.tfar < 0 ? 1 : 0;
      }
    }
  }

  void cast_packets(bool is_closest, bool is_coherent, std::size_t first, std::size_t last,
                    std::uint8_t* hits) const {
    RTCIntersectContext ctx = context(is_coherent);
    alignas(64) int valid[kPacket];
    for (std::size_t i = first; i < last; i += kPacket) {
      const std::size_t count = std::min(kPacket, last - i);
      for (std::size_t lane = 0; lane < kPacket; ++lane) valid[lane] = lane < count ? -1 : 0;
      if (is_closest) {
        RTCRayHit16 query;
        query.ray = packets_[i / kPacket].value;
        std::fill_n(query.hit.geomID, kPacket, RTC_INVALID_GEOMETRY_ID);
        std::fill_n(query.hit.instID[0], kPacket, RTC_INVALID_GEOMETRY_ID);
        rtcIntersect16(valid, embree_.scene(), &ctx, &query);
        for (std::size_t lane = 0; lane < count; ++lane)
          hits[i + lane] = query.hit.geomID[lane] != RTC_INVALID_GEOMETRY_ID ? 1 : 0;
      } else {
        RTCRay16 rays = packets_[i / kPacket].value;
        rtcOccluded16(valid, embree_.scene(), &ctx, &rays);
        for (std::size_t lane = 0; lane < count; ++lane)
          hits[i + lane] = rays.tfar[lane] < 0 ? 1 : 0;
      }
    }
  }

 private:
  EmbreeScene embree_;
  std::vector<RTCRay> singles_;
  std::vector<AlignedPacket<RTCRay16>> packets_;
};

EmbreeRival::EmbreeRival(Mesh mesh)
    : Rival("embree"), scene_(std::make_unique<Scene>(std::move(mesh))) {}
EmbreeRival::~EmbreeRival() = default;

bool EmbreeRival::is_available() { return true; }

std::vector<TraceRunner> EmbreeRival::prepare(const Grid& grid, const RaySet& set) {
  scene_->convert(grid, set.casts);
  const bool closest = is_closest(set.rays_class);
  std::vector<TraceRunner> runners;
  runners.push_back({"embree_single",
                     [this, closest](std::size_t first, std::size_t last, std::uint8_t* hits) {
                       scene_->cast_single(closest, first, last, hits);
                     },
                     {}});
  runners.back().closest_t = [this](std::size_t i) { return scene_->closest_t(i); };
  for (const bool is_coherent : {true, false})
    runners.push_back(
        {"embree_packet16",
         [this, closest, is_coherent](std::size_t first, std::size_t last, std::uint8_t* hits) {
           scene_->cast_packets(closest, is_coherent, first, last, hits);
         },
         {}});
  return runners;
}

}  // namespace voxdag::lab

#else

namespace voxdag::lab {

class EmbreeRival::Scene {};

EmbreeRival::EmbreeRival(Mesh) : Rival("embree") {}
EmbreeRival::~EmbreeRival() = default;
bool EmbreeRival::is_available() { return false; }
std::vector<TraceRunner> EmbreeRival::prepare(const Grid&, const RaySet&) { return {}; }

}  // namespace voxdag::lab

#endif
