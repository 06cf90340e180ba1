/// tinybvh casts rays at triangles. Its BVH8_CPU needs AVX2, with which only this file is compiled.
#include "lab/rivals/tinybvh_rival.hpp"

#if VOXDAG_HAS_TINYBVH

#define TINYBVH_IMPLEMENTATION
#include <tiny_bvh.h>

#include <cmath>

namespace voxdag::lab {
namespace {

tinybvh::bvhvec3 to_tinybvh(Vec3d v) {
  return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// A ray for tinybvh, whose rays have no t_min: the origin is the point at voxdag's t_min.
struct TinybvhRay {
  tinybvh::bvhvec3 origin, direction, inverse;
  float length = 0;
  float t_min = 0, scale = 0;  ///< voxdag's t is t_min + scale * distance from `origin`.

  TinybvhRay(const WorldRay& world, Vec3d mesh_origin) : t_min(world.t_min) {
    const double speed = std::sqrt(dot(world.direction, world.direction));
    const Vec3d start =
        world.origin + world.direction * static_cast<double>(world.t_min) - mesh_origin;
    length = static_cast<float>(
        (static_cast<double>(world.t_max) - static_cast<double>(world.t_min)) * speed);
    scale = static_cast<float>(1 / speed);
    const tinybvh::Ray ray(to_tinybvh(start), to_tinybvh(world.direction * (1 / speed)));
    origin = ray.O;
    direction = ray.D;
    inverse = ray.rD;
  }

  void copy_to(tinybvh::Ray& ray) const {
    ray.O = origin;
    ray.D = direction;
    ray.rD = inverse;
    ray.hit.t = length;
  }
};

class TinybvhRival : public Rival {
 public:
  explicit TinybvhRival(const Mesh& mesh) : Rival("tinybvh"), origin_(mesh.origin) {
    for (const Triangle& triangle : mesh.triangles)
      for (const std::uint32_t vertex : triangle) {
        const Vec3f& p = mesh.vertices[vertex];
        corners_.push_back({p.x, p.y, p.z, 0});
      }
    const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
    plain_.Build(corners_.data(), count);
    hq_.BuildHQ(corners_.data(), count);
  }

  std::vector<TraceRunner> prepare(const Grid& grid, const RaySet& set) override {
    rays_.clear();
    for (const CastRay& cast : set.casts) rays_.emplace_back(to_world_ray(grid, cast.ray), origin_);
    return {runner("tinybvh", plain_, is_closest(set.rays_class)),
            runner("tinybvh_hq", hq_, is_closest(set.rays_class))};
  }

 private:
  TraceRunner runner(const char* name, const tinybvh::BVH8_CPU& bvh, bool is_closest) const {
    TraceRunner result;
    result.name = name;
    result.cast = [this, &bvh, is_closest](std::size_t first, std::size_t last,
                                           std::uint8_t* hits) {
      tinybvh::Ray ray;
      for (std::size_t i = first; i < last; ++i) {
        rays_[i].copy_to(ray);
        if (is_closest) bvh.Intersect(ray);
        hits[i] = (is_closest ? ray.hit.t < rays_[i].length : bvh.IsOccluded(ray)) ? 1 : 0;
      }
    };
    result.closest_t = [this, &bvh](std::size_t i) {
      tinybvh::Ray ray;
      rays_[i].copy_to(ray);
      bvh.Intersect(ray);
      return ray.hit.t < rays_[i].length ? rays_[i].t_min + ray.hit.t * rays_[i].scale : HUGE_VALF;
    };
    return result;
  }

  Vec3d origin_;
  std::vector<tinybvh::bvhvec4> corners_;  // three of each triangle
  tinybvh::BVH8_CPU plain_, hq_;
  std::vector<TinybvhRay> rays_;
};

}  // namespace

std::unique_ptr<Rival> make_tinybvh_rival(const Mesh& mesh) {
  const bool can_run = __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma");
  if (!can_run || mesh.triangles.empty()) return nullptr;
  return std::make_unique<TinybvhRival>(mesh);
}

}  // namespace voxdag::lab

#else

std::unique_ptr<voxdag::lab::Rival> voxdag::lab::make_tinybvh_rival(const Mesh&) { return nullptr; }

#endif
