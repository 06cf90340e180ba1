#include "voxdag/mesh_view/mesh_view_source.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "voxdag/mesh_view/embree_scene.hpp"

namespace voxdag {
namespace {

constexpr int kPacketSide = 4;
constexpr int kPacket = kPacketSide * kPacketSide;

/// Returns the point where a line meets the plane of a triangle, as the weights of corners 1 and 2.
/// Returns nothing if line and plane are nearly parallel.
std::optional<Vec2d> meet_plane(const std::array<Vec3d, 3>& corners, Vec3d origin,
                                Vec3d direction) {
  const Vec3d ab = corners[1] - corners[0], ac = corners[2] - corners[0], ao = origin - corners[0];
  const Vec3d n = cross(ab, ac);
  const double facing = dot(n, direction);
  const double most = std::sqrt(dot(n, n) * dot(direction, direction));
  if (!(std::fabs(facing) > 1e-12 * most)) return {};
  const Vec3d moment = cross(direction, ao);
  return Vec2d{dot(ac, moment) / facing, -dot(ab, moment) / facing};
}

/// Returns a point of the triangle close to `at`.
Vec2d into_triangle(Vec2d at) {
  double u = std::clamp(at.x, 0.0, 1.0), v = std::clamp(at.y, 0.0, 1.0);
  if (const double sum = u + v; sum > 1) {
    u /= sum;
    v /= sum;
  }
  return {u, v};
}

Vec2f to_float(Vec2d v) { return {static_cast<float>(v.x), static_cast<float>(v.y)}; }

/// Returns the unit vector closest to `normal` that does not face away from the viewer.
Vec3f turned_to(Vec3f normal, Vec3f view) {
  constexpr float kMinCosine = 0.02f;
  const float cosine = dot(normal, view);
  return cosine >= kMinCosine ? normal : normalized(normal + view * (kMinCosine - cosine));
}

}  // namespace

class MeshViewSource::Scene {
 public:
  Scene(Mesh mesh, const MeshViewOptions& options)
      : embree_(std::move(mesh), EmbreeMode::kRobust), appearance_(embree_.mesh(), options) {}
  Scene(Mesh mesh, Appearance appearance, const MeshViewOptions& options,
        std::vector<std::string>* warnings, Work work)
      : embree_(std::move(mesh), EmbreeMode::kRobust),
        appearance_(embree_.mesh(), std::move(appearance), options, warnings, work) {}

  /// Casts the rays of up to 4×4 pixels.
  void sample_packet(const Camera& camera, const ViewTile& tile, int x0, int y0,
                     std::span<ViewSample> samples) const;

 private:
  /// Returns the point at which the line comes close to the mesh, in Embree's coordinates. From
  /// there on, floats are precise enough even for a distant viewer.
  Vec3d near_origin(Vec3d eye, Vec3d direction) const {
    const Vec3d from = embree_.from_world(eye);
    const double length2 = dot(direction, direction);
    const double t = -dot(from, direction) / length2 - embree_.radius() / std::sqrt(length2);
    return direction * std::max(t, 0.0) + from;
  }

  /// Returns the sample of the ray, in Embree's coordinates, through (x,y) in the picture. `guess`
  /// is the hit in float arithmetic.
  ViewSample view_sample(const Camera& camera, double x, double y, Vec3d origin, Vec3d direction,
                         std::uint32_t triangle, Vec2d guess) const;

  /// Lets rays pass through alpha-masked parts.
  struct Context : RTCIntersectContext {
    const MeshAppearance* appearance;
  };
  static void skip_holes(const RTCFilterFunctionNArguments* hits);

  EmbreeScene embree_;
  MeshAppearance appearance_;
};

void MeshViewSource::Scene::skip_holes(const RTCFilterFunctionNArguments* hits) {
  const MeshAppearance& appearance = *static_cast<const Context*>(hits->context)->appearance;
  for (unsigned i = 0; i < hits->N; ++i) {
    if (hits->valid[i] != -1) continue;
    const Vec2f at{RTCHitN_u(hits->hit, hits->N, i), RTCHitN_v(hits->hit, hits->N, i)};
    if (appearance.is_hole(RTCHitN_primID(hits->hit, hits->N, i), at)) hits->valid[i] = 0;
  }
}

ViewSample MeshViewSource::Scene::view_sample(const Camera& camera, double x, double y,
                                              Vec3d origin, Vec3d direction, std::uint32_t triangle,
                                              Vec2d guess) const {
  const Mesh& mesh = embree_.mesh();
  std::array<Vec3d, 3> corners;
  for (std::size_t i = 0; i < 3; ++i)
    corners[i] = static_cast<Vec3d>(mesh.vertices[mesh.triangles[triangle][i]]);
  const Vec2d at = into_triangle(meet_plane(corners, origin, direction).value_or(guess));
  ViewSample sample;
  sample.point =
      embree_.to_world(corners[0] * (1 - at.x - at.y) + corners[1] * at.x + corners[2] * at.y);
  sample.depth = static_cast<float>(dot(sample.point - camera.eye, camera.forward));

  // The pixel's footprint on the triangle: where the rays of its corners meet the plane.
  std::array<Vec2f, 4> footprint;
  for (int i = 0; i < 4; ++i) {
    const double dx = i == 0 || i == 3 ? -0.5 : 0.5, dy = i < 2 ? -0.5 : 0.5;
    const auto met =
        meet_plane(corners, embree_.from_world(camera.eye), camera.direction(x + dx, y + dy));
    footprint[i] = to_float(into_triangle(met.value_or(at)));
  }
  sample.albedo = appearance_.albedo(triangle, footprint);

  const Vec3f view = static_cast<Vec3f>(normalized(-direction));
  const Vec3d winding = cross(corners[1] - corners[0], corners[2] - corners[0]);
  const double area2 = length(winding);
  if (!(area2 > 0)) {  // Embree reports no triangles without area, but it decides in float
    sample.face = sample.normal = view;
    return sample;
  }
  sample.face = static_cast<Vec3f>(winding * ((dot(winding, direction) > 0 ? -1 : 1) / area2));
  Vec3f normal = appearance_.normal(triangle, to_float(at), footprint);
  // The normals of a file may disagree with the winding.
  if (dot(normal, sample.face) < 0) normal = -normal;
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
  Context context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  context.appearance = &appearance_;
  if (appearance_.has_holes()) context.filter = skip_holes;
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
    sample = view_sample(camera, tile.x + column + tile.dx, tile.y + row + tile.dy, origins[i],
                         directions[i], packet.hit.primID[i], {u, v});
  }
}

MeshViewSource::MeshViewSource(Mesh mesh, const MeshViewOptions& options)
    : scene_(std::make_unique<Scene>(std::move(mesh), options)) {}

MeshViewSource::MeshViewSource(Mesh mesh, Appearance appearance, const MeshViewOptions& options,
                               std::vector<std::string>* warnings, Work work)
    : scene_(std::make_unique<Scene>(std::move(mesh), std::move(appearance), options, warnings,
                                     work)) {}

MeshViewSource::~MeshViewSource() = default;

void MeshViewSource::sample(const Camera& camera, const ViewTile& tile,
                            std::span<ViewSample> samples) const {
  for (int y = 0; y < tile.height; y += kPacketSide)
    for (int x = 0; x < tile.width; x += kPacketSide)
      scene_->sample_packet(camera, tile, x, y, samples);
}

}  // namespace voxdag
