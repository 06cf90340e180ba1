#include "voxdag/mesh/surface/tangent_frames.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <unordered_map>

namespace voxdag {
namespace {

/// The key of a corner. Equal corners share a tangent.
struct Corner {
  Vec3f position, normal;
  Vec2f uv;
  bool mirrored = false;
  friend bool operator==(const Corner&, const Corner&) = default;
};

struct CornerHash {
  std::size_t operator()(const Corner& corner) const {
    std::uint64_t h = corner.mirrored;
    for (const float f : {corner.position.x, corner.position.y, corner.position.z, corner.normal.x,
                          corner.normal.y, corner.normal.z, corner.uv.x, corner.uv.y})
      h = (h ^ std::bit_cast<std::uint32_t>(f + 0.0f)) * 0x9E3779B97F4A7C15ull, h ^= h >> 29;
    return h;
  }
};

void report_tangents(Work work, std::size_t triangle, std::size_t count) {
  if (triangle % 65536 != 0) return;
  work.poll();
  work.report_done("tangents", triangle, count);
}

}  // namespace

Vec3f face_normal(const Mesh& mesh, std::size_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  const Vec3f a = mesh.vertices[t[0]];
  const Vec3f normal = normalized_or(cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a), {});
  if (normal != Vec3f{}) return normal;
  // Computes in double, because the areas of tiny triangles underflow in float32.
  const Vec3d d(a);
  return static_cast<Vec3f>(
      normalized_or(cross(Vec3d(mesh.vertices[t[1]]) - d, Vec3d(mesh.vertices[t[2]]) - d), {}));
}

TangentTable::TangentTable(
    const Mesh& mesh, const Appearance& appearance,
    const std::function<const UvTransform*(std::size_t triangle)>& uv_transform, Work work)
    : places_(mesh.triangles.size(), kNone, work.memory), tangents_(work.memory) {
  using Sums = std::unordered_map<Corner, Vec3f, CornerHash, std::equal_to<>,
                                  CountedAllocator<std::pair<const Corner, Vec3f>>>;
  Sums sums{Sums::allocator_type(work.memory)};
  const auto corner_of = [&](std::size_t t, std::size_t c, bool mirrored) {
    Corner corner{mesh.vertices[mesh.triangles[t][c]], {}, appearance.uvs[3 * t + c], mirrored};
    if (!appearance.normals.empty()) corner.normal = appearance.normals[3 * t + c];
    if (corner.normal == Vec3f{}) corner.normal = face_normal(mesh, t);
    return corner;
  };
  std::uint32_t count = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    report_tangents(work, t, mesh.triangles.size());
    const UvTransform* const transform = uv_transform(t);
    if (transform == nullptr) continue;
    std::array<Vec3f, 3> p;
    std::array<Vec2f, 3> uv;
    for (std::size_t c = 0; c < 3; ++c) {
      p[c] = mesh.vertices[mesh.triangles[t][c]];
      uv[c] = transform->linear(appearance.uvs[3 * t + c]);
    }
    const Vec3f e1 = p[1] - p[0], e2 = p[2] - p[0];
    const Vec2f d1 = uv[1] - uv[0], d2 = uv[2] - uv[0];
    const float area = cross(d1, d2);
    const Vec3f along_u = normalized_or((e1 * d2.y - e2 * d1.y) * (area < 0 ? -1.0f : 1.0f), {});
    const Vec3f up = normalized_or((e1 * d2.x - e2 * d1.x) * (area < 0 ? -1.0f : 1.0f), {});
    if (area == 0 || along_u == Vec3f{} || up == Vec3f{}) continue;
    Vec3f normal{};
    for (std::size_t c = 0; c < 3; ++c) normal = normal + corner_of(t, c, false).normal;
    const bool mirrored = dot(cross(normal, along_u), up) < 0;
    places_[t] = count++ | (mirrored ? kMirrored : 0);
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3f a = normalized_or(p[(c + 1) % 3] - p[c], {}),
                  b = normalized_or(p[(c + 2) % 3] - p[c], {});
      const auto angle = static_cast<float>(arc_cosine(std::clamp(dot(a, b), -1.0f, 1.0f)));
      Vec3f& sum = sums[corner_of(t, c, mirrored)];
      sum = sum + along_u * angle;
    }
  }
  tangents_.resize(3 * std::size_t{count});
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    if (places_[t] == kNone) continue;
    const bool mirrored = (places_[t] & kMirrored) != 0;
    for (std::size_t c = 0; c < 3; ++c)
      tangents_[3 * std::size_t{places_[t] & ~kMirrored} + c] =
          normalized_or(sums[corner_of(t, c, mirrored)], {});
  }
}

}  // namespace voxdag
