#include "lab/contacts/embree_closest.hpp"

#if VOXDAG_HAS_EMBREE

#include <algorithm>
#include <cmath>

#include "voxdag/core/parallel/parallel_for.hpp"
#include "voxdag/mesh_view/embree_scene.hpp"

namespace voxdag::lab {
namespace {

/// Returns the point of a triangle that is nearest to p.
///
/// Source: C. Ericson, "Real-Time Collision Detection", 2005, section 5.1.5.
Vec3f nearest_in_triangle(Vec3f p, Vec3f a, Vec3f b, Vec3f c) {
  const Vec3f ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
  const float d1 = dot(ab, ap), d2 = dot(ac, ap), d3 = dot(ab, bp), d4 = dot(ac, bp);
  const float d5 = dot(ab, cp), d6 = dot(ac, cp);
  if (d1 <= 0 && d2 <= 0) return a;
  if (d3 >= 0 && d4 <= d3) return b;
  if (d6 >= 0 && d5 <= d6) return c;
  const float vc = d1 * d4 - d3 * d2, vb = d5 * d2 - d1 * d6, va = d3 * d6 - d5 * d4;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return a + ab * (d1 / (d1 - d3));
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + ac * (d2 / (d2 - d6));
  if (va <= 0 && d4 >= d3 && d5 >= d6) return b + (c - b) * ((d4 - d3) / ((d4 - d3) + (d5 - d6)));
  const float all = 1 / (va + vb + vc);
  return a + ab * (vb * all) + ac * (vc * all);
}

/// Shrinks the query to a triangle that is nearer.
bool look_at_triangle(RTCPointQueryFunctionArguments* found) {
  const Mesh& mesh = *static_cast<const Mesh*>(found->userPtr);
  const Triangle& triangle = mesh.triangles[found->primID];
  const Vec3f p{found->query->x, found->query->y, found->query->z};
  const float distance =
      length(p - nearest_in_triangle(p, mesh.vertices[triangle[0]], mesh.vertices[triangle[1]],
                                     mesh.vertices[triangle[2]]));
  if (!(distance < found->query->radius)) return false;
  found->query->radius = distance;
  return true;
}

}  // namespace

class EmbreeClosest::Scene {
 public:
  explicit Scene(Mesh mesh) : embree_(std::move(mesh), EmbreeMode::kFast) {}

  double find(Vec3d world, double most) const {
    const Vec3f p = static_cast<Vec3f>(embree_.from_world(world));
    const auto reach = static_cast<float>(most * embree_.scale());
    RTCPointQuery query{};
    query.x = p.x;
    query.y = p.y;
    query.z = p.z;
    query.radius = reach;
    RTCPointQueryContext context;
    rtcInitPointQueryContext(&context);
    rtcPointQuery(embree_.scene(), &query, &context, look_at_triangle,
                  const_cast<Mesh*>(&embree_.mesh()));  // Embree's pointers are not const.
    return query.radius < reach ? static_cast<double>(query.radius) / embree_.scale() : HUGE_VAL;
  }

 private:
  EmbreeScene embree_;
};

EmbreeClosest::EmbreeClosest(Mesh mesh) : scene_(std::make_unique<Scene>(std::move(mesh))) {}
EmbreeClosest::~EmbreeClosest() = default;
bool EmbreeClosest::is_available() { return true; }

void EmbreeClosest::find(std::span<const Vec3d> points, double most,
                         std::span<double> distances) const {
  parallel_for(points.size(), 64,
               [&](std::size_t i) { distances[i] = scene_->find(points[i], most); });
}

}  // namespace voxdag::lab

#else

namespace voxdag::lab {

class EmbreeClosest::Scene {};

EmbreeClosest::EmbreeClosest(Mesh) {}
EmbreeClosest::~EmbreeClosest() = default;
bool EmbreeClosest::is_available() { return false; }
void EmbreeClosest::find(std::span<const Vec3d>, double, std::span<double>) const {}

}  // namespace voxdag::lab

#endif
