#include "voxdag/deferred/mesh_view_source.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "voxdag/deferred/corner_normals.hpp"
#include "voxdag/deferred/embree_scene.hpp"

namespace voxdag {
namespace {

constexpr int kPacketSide = 4;
constexpr int kPacket = kPacketSide * kPacketSide;

/// A point of a triangle: its corners weighted.
struct Barycentrics {
  std::array<double, 3> weights;
};

/// The triangle's point nearest to where the line meets its plane, in double. `guess` is what float
/// arithmetic found; it stays where line and plane are all but parallel.
Barycentrics refine(const std::array<Vec3d, 3>& corners, Vec3d origin, Vec3d direction,
                    Barycentrics guess) {
  const Vec3d ab = corners[1] - corners[0], ac = corners[2] - corners[0], ao = origin - corners[0];
  const Vec3d n = cross(ab, ac);
  const double facing = dot(n, direction);
  const double most = std::sqrt(dot(n, n) * dot(direction, direction));
  if (!(std::fabs(facing) > 1e-12 * most)) return guess;
  const Vec3d moment = cross(direction, ao);
  double u = dot(ac, moment) / facing, v = -dot(ab, moment) / facing;
  u = std::clamp(u, 0.0, 1.0);
  v = std::clamp(v, 0.0, 1.0);
  if (const double sum = u + v; sum > 1) {
    u /= sum;
    v /= sum;
  }
  return {{1 - u - v, u, v}};
}

/// The vector of unit length nearest to `normal` that does not face away from the viewer.
Vec3f turned_to(Vec3f normal, Vec3f view) {
  constexpr float kLeastCosine = 0.02f;
  const float cosine = dot(normal, view);
  return cosine >= kLeastCosine ? normal : normalized(normal + view * (kLeastCosine - cosine));
}

}  // namespace

class MeshViewSource::Scene {
 public:
  Scene(Mesh mesh, const MeshViewOptions& options)
      : albedo_(options.albedo),
        normals_(corner_normals(mesh, options.crease_degrees)),
        embree_(std::move(mesh), EmbreeMode::kRobust) {}

  /// Casts the rays of up to 4x4 pixels.
  void sample_packet(const Camera& camera, const ViewTile& tile, int x0, int y0,
                     std::span<ViewSample> samples) const;

 private:
  /// Where the line comes near the mesh, relative to the mesh's centre: what is left of the ray
  /// suits floats however far the viewer is.
  Vec3d near_origin(Vec3d eye, Vec3d direction) const {
    const Vec3d to_center = embree_.center() - eye;
    const double length2 = dot(direction, direction);
    const double t = dot(to_center, direction) / length2 - embree_.radius() / std::sqrt(length2);
    return direction * std::max(t, 0.0) - to_center;
  }

  ViewSample view_sample(const Camera& camera, Vec3d origin, Vec3d direction,
                         std::uint32_t triangle, Barycentrics guess) const;

  Vec3f albedo_;
  std::vector<std::array<PackedNormal, 3>> normals_;
  EmbreeScene embree_;
};

ViewSample MeshViewSource::Scene::view_sample(const Camera& camera, Vec3d origin, Vec3d direction,
                                              std::uint32_t triangle, Barycentrics guess) const {
  const Mesh& mesh = embree_.mesh();
  std::array<Vec3d, 3> corners;
  for (int i = 0; i < 3; ++i)
    corners[i] = static_cast<Vec3d>(mesh.vertices[mesh.triangles[triangle][i]]);
  const auto weights = refine(corners, origin, direction, guess).weights;
  ViewSample sample;
  sample.albedo = albedo_;
  sample.point = corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2] +
                 embree_.center();
  sample.depth = static_cast<float>(dot(sample.point - camera.eye, camera.forward));

  const Vec3f view = static_cast<Vec3f>(normalized(-direction));
  const Vec3d winding = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double length = std::sqrt(dot(winding, winding));
  if (!(length > 0)) {  // Embree does not report triangles without area, but floats are not sure
    sample.face = sample.normal = view;
    return sample;
  }
  const bool is_back = dot(winding, direction) > 0;
  sample.face = static_cast<Vec3f>(winding * ((is_back ? -1 : 1) / length));
  Vec3f normal{};
  for (int i = 0; i < 3; ++i)
    normal = normal + normals_[triangle][i].unpack() * static_cast<float>(weights[i]);
  if (is_back) normal = -normal;
  sample.normal = dot(normal, normal) > 0 ? turned_to(normalized(normal), view) : sample.face;
  return sample;
}

void MeshViewSource::Scene::sample_packet(const Camera& camera, const ViewTile& tile, int x0,
                                          int y0, std::span<ViewSample> samples) const {
  alignas(64) std::array<int, kPacket> valid{};
  RTCRayHit16 packet;
  std::array<Vec3d, kPacket> origins, directions;
  const int width = std::min(kPacketSide, tile.width - x0);
  const int height = std::min(kPacketSide, tile.height - y0);
  for (int i = 0; i < kPacket; ++i) {
    const int x = i % kPacketSide, y = i / kPacketSide;
    valid[i] = x < width && y < height ? -1 : 0;
    directions[i] = camera.direction(tile.x + x0 + x + tile.dx, tile.y + y0 + y + tile.dy);
    origins[i] = near_origin(camera.eye, directions[i]);
    const Vec3f o = static_cast<Vec3f>(origins[i]), d = static_cast<Vec3f>(directions[i]);
    packet.ray.org_x[i] = o.x;
    packet.ray.org_y[i] = o.y;
    packet.ray.org_z[i] = o.z;
    packet.ray.dir_x[i] = d.x;
    packet.ray.dir_y[i] = d.y;
    packet.ray.dir_z[i] = d.z;
    packet.ray.tnear[i] = 0;
    packet.ray.tfar[i] = HUGE_VALF;
    packet.ray.time[i] = 0;
    packet.ray.mask[i] = ~0u;
    packet.ray.id[i] = 0;
    packet.ray.flags[i] = 0;
    packet.hit.geomID[i] = RTC_INVALID_GEOMETRY_ID;
    packet.hit.instID[0][i] = RTC_INVALID_GEOMETRY_ID;
  }
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  rtcIntersect16(valid.data(), embree_.scene(), &context, &packet);
  for (int i = 0; i < kPacket; ++i) {
    if (valid[i] == 0) continue;
    const int row = y0 + i / kPacketSide, column = x0 + i % kPacketSide;
    ViewSample& sample =
        samples[static_cast<std::size_t>(row) * static_cast<std::size_t>(tile.width) +
                static_cast<std::size_t>(column)];
    sample = {};
    if (packet.hit.geomID[i] == RTC_INVALID_GEOMETRY_ID) continue;
    const double u = static_cast<double>(packet.hit.u[i]), v = static_cast<double>(packet.hit.v[i]);
    sample =
        view_sample(camera, origins[i], directions[i], packet.hit.primID[i], {{1 - u - v, u, v}});
  }
}

MeshViewSource::MeshViewSource(Mesh mesh, const MeshViewOptions& options)
    : scene_(std::make_unique<Scene>(std::move(mesh), options)) {}

MeshViewSource::~MeshViewSource() = default;

void MeshViewSource::sample(const Camera& camera, const ViewTile& tile,
                            std::span<ViewSample> samples) const {
  for (int y = 0; y < tile.height; y += kPacketSide)
    for (int x = 0; x < tile.width; x += kPacketSide)
      scene_->sample_packet(camera, tile, x, y, samples);
}

}  // namespace voxdag
