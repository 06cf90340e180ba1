#include "voxdag/mesh/displace/displaced_point.hpp"

#include <algorithm>
#include <cmath>

namespace voxdag {
namespace {

/// Returns the weights of the textures that are projected along each axis, for a unit normal. Their
/// sum is 1.
Vec3f projection_weights(Vec3f n) {
  const auto weight = [](float x) {
    const float w = std::max(std::abs(x) - 0.4f, 0.0f);
    return w * w;
  };
  const Vec3f w{weight(n.x), weight(n.y), weight(n.z)};
  return w * (1 / (w.x + w.y + w.z));  // The divisor is not 0: one component is at least 0.57.
}

/// Returns a height, 0 to 1.
float height(const Displacement& d, Vec3d position, Vec3f unit_normal, Vec2f uv, float level) {
  if (!(d.box_size > 0)) return d.heights->sample_between(level, d.uv(uv))[0] * (1.0f / 65535);
  const Vec3f weights = projection_weights(unit_normal);
  float sum = 0;
  for (int axis = 0; axis < 3; ++axis)
    if (weights[axis] > 0)
      sum += weights[axis] *
             d.heights->sample_between(level, projected_uv(position, axis, d.box_size))[0];
  return sum * (1.0f / 65535);
}

}  // namespace

Vec2f projected_uv(Vec3d p, int axis, double size) {
  const double u = (axis == 0 ? p.z : p.x) / size, v = (axis == 1 ? p.z : -p.y) / size;
  return {static_cast<float>(u - std::floor(u)), static_cast<float>(v - std::floor(v))};
}

double texel_density(const DisplacedMesh& mesh, std::uint32_t triangle) {
  const Displacement& d = mesh.displacement(triangle);
  if (!d.moves()) return 0;
  const double w = d.heights->width(), h = d.heights->height();
  if (d.box_size > 0) return std::max(w, h) / d.box_size;
  const CornerIndex c = 3 * triangle;
  const Vec2f p = d.uv.linear(mesh.uv(c + 1) - mesh.uv(c)),
              q = d.uv.linear(mesh.uv(c + 2) - mesh.uv(c));
  const double texels = std::abs(double{p.x} * q.y - double{p.y} * q.x) * w * h;
  const Vec3d a(mesh.position(c));
  const Vec3d area = cross(Vec3d(mesh.position(c + 1)) - a, Vec3d(mesh.position(c + 2)) - a);
  const double world = std::sqrt(dot(area, area));
  return world > 0 ? std::sqrt(texels / world) : 0;
}

double edge_texel_density(const DisplacedMesh& mesh, CornerIndex edge) {
  const Displacement& d = mesh.displacement(edge / 3);
  if (!d.moves()) return 0;
  const double w = d.heights->width(), h = d.heights->height();
  if (d.box_size > 0) return std::max(w, h) / d.box_size;
  const CornerIndex end = next_corner(edge);
  const Vec2f along = d.uv.linear(mesh.uv(end) - mesh.uv(edge));
  const Vec3d length = Vec3d(mesh.position(end)) - Vec3d(mesh.position(edge));
  const double across = along.x * w, down = along.y * h;
  const double texels = std::sqrt(across * across + down * down);
  const double world = std::sqrt(dot(length, length));
  return world > 0 ? texels / world : 0;
}

float height_level(double texel_density, double edge_limit) {
  // Tessellation leaves edges between half of the limit and the limit.
  return static_cast<float>(std::log2(texel_density * edge_limit * 0.7));
}

Vec3d triangle_offset(const DisplacedMesh& mesh, std::uint32_t triangle, Vec3d position,
                      Vec3f normal, Vec2f uv, float level) {
  const Displacement& d = mesh.displacement(triangle);
  const Vec3f n = normalized_or(normal, {});
  if (n == Vec3f{}) return {};
  return Vec3d(n) * (d.base + d.gain * static_cast<double>(height(d, position, n, uv, level)));
}

Vec3d corner_offset(const DisplacedMesh& mesh, const DisplacementSeams::Group& group,
                    Vec3d position, double edge_limit) {
  if (group.is_pinned) return {};
  Vec3d sum;
  for (const CornerIndex c : group.members)
    sum = sum + triangle_offset(mesh, c / 3, position, mesh.normals(c / 3)[c % 3], mesh.uv(c),
                                height_level(texel_density(mesh, c / 3), edge_limit));
  return sum * (1.0 / static_cast<double>(group.members.size()));
}

Vec3d edge_offset(const DisplacedMesh& mesh, const DisplacementSeams& seams,
                  const DisplacementSeams::Group& group, Vec3d position, float along,
                  double edge_limit) {
  if (group.is_pinned) return {};
  double density = 0;
  for (const CornerIndex edge : group.members)
    density = std::max(density, edge_texel_density(mesh, edge));
  const float level = height_level(density, edge_limit);
  Vec3d sum;
  for (const CornerIndex edge : group.members) {
    const auto [a, b] = seams.ends(edge);
    const std::array<Vec3f, 3> n = mesh.normals(a / 3);
    sum = sum + triangle_offset(mesh, a / 3, position, n[a % 3] + (n[b % 3] - n[a % 3]) * along,
                                mesh.uv(a) + (mesh.uv(b) - mesh.uv(a)) * along, level);
  }
  return sum * (1.0 / static_cast<double>(group.members.size()));
}

}  // namespace voxdag
