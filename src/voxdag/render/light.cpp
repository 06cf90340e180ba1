#include "voxdag/render/light.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "voxdag/core/error.hpp"
#include "voxdag/render/basis.hpp"
#include "voxdag/render/sky.hpp"

namespace voxdag {
namespace {

void check(const LightSpec& spec) {
  for (const Vec3d v : {spec.position, spec.normal, spec.edge_u, spec.edge_v})
    if (!is_finite(v)) throw Error("a light's coordinates must be finite");
  const bool needs_radius = spec.kind == LightKind::kDisc || spec.kind == LightKind::kSphere;
  if (!(spec.radius >= 0 && spec.radius < HUGE_VAL) || (needs_radius && spec.radius == 0))
    throw Error("a light's radius must be greater than zero");
  if (spec.kind == LightKind::kSun && !(dot(spec.position, spec.position) > 0))
    throw Error("the direction of the sun must not be zero");
  if (spec.kind == LightKind::kDisc && !(dot(spec.normal, spec.normal) > 0))
    throw Error("the normal of a disc light must not be zero");
  const Vec3d span = cross(spec.edge_u, spec.edge_v);
  if (spec.kind == LightKind::kRectangle && !(dot(span, span) > 0))
    throw Error("the two edges of a rectangle light must not be zero or parallel");
  if (!spec.color) return;
  for (int i = 0; i < 3; ++i)
    if (!((*spec.color)[i] >= 0 && (*spec.color)[i] < HUGE_VALF))
      throw Error("a light's colour must be finite and not negative");
}

/// Sets a box around the light, widened by more than the rounding errors of float samples.
void set_bounds(Light& light) {
  constexpr float kRounding = 1e-5f;
  for (int axis = 0; axis < 3; ++axis) {
    const float u = std::fabs(light.u[axis]), v = std::fabs(light.v[axis]);
    float below = 0, above = 0;
    switch (light.kind) {
      case LightKind::kSun:
      case LightKind::kDisc:
        below = above = std::sqrt(u * u + v * v);
        break;
      case LightKind::kSphere:
        below = above = light.radius;
        break;
      case LightKind::kRectangle:
        above = std::max(light.u[axis], 0.0f) + std::max(light.v[axis], 0.0f);
        below = std::max(-light.u[axis], 0.0f) + std::max(-light.v[axis], 0.0f);
        break;
      case LightKind::kPoint:
        break;
    }
    const float slack = kRounding * (1 + std::fabs(light.position[axis]) + below + above);
    light.lowest[axis] = light.position[axis] - below - slack;
    light.highest[axis] = light.position[axis] + above + slack;
  }
}

/// Returns the colour with which the light gives `irradiance` on a surface that faces it at a large
/// `distance`.
Vec3f color_for(const Light& light, Vec3f irradiance, float distance) {
  const float distance2 = distance * distance;
  switch (light.kind) {
    case LightKind::kSun:
      return irradiance;
    case LightKind::kPoint:
      return irradiance * distance2;
    case LightKind::kSphere:
      return irradiance * (distance2 / (std::numbers::pi_v<float> * light.radius * light.radius));
    default:
      return irradiance * (distance2 / light.area);
  }
}

}  // namespace

Light make_light(const LightSpec& spec, const Grid& grid) {
  check(spec);
  const double to_unit = 1.0 / grid.side();
  const auto in_grid = [to_unit](Vec3d v) { return static_cast<Vec3f>(v * to_unit); };
  Light light;
  light.kind = spec.kind;
  light.position = static_cast<Vec3f>((spec.position - grid.origin) * to_unit + Vec3d{1, 1, 1});
  light.radius = static_cast<float>(spec.radius * to_unit);
  if (spec.kind == LightKind::kSun) {
    const Vec3d towards = normalized(spec.position);
    const Basis<double> basis = make_basis(towards);
    light.position = static_cast<Vec3f>(towards);
    light.radius = static_cast<float>(spec.radius);
    light.u = static_cast<Vec3f>(basis.u * spec.radius);
    light.v = static_cast<Vec3f>(basis.v * spec.radius);
  } else if (spec.kind == LightKind::kDisc) {
    const Vec3d normal = normalized(spec.normal);
    const Basis<double> basis = make_basis(normal);
    light.normal = static_cast<Vec3f>(normal);
    light.u = in_grid(basis.u * spec.radius);
    light.v = in_grid(basis.v * spec.radius);
    light.area = std::numbers::pi_v<float> * light.radius * light.radius;
  } else if (spec.kind == LightKind::kRectangle) {
    const Vec3d span = cross(spec.edge_u, spec.edge_v);
    light.normal = static_cast<Vec3f>(normalized(span));
    light.u = in_grid(spec.edge_u);
    light.v = in_grid(spec.edge_v);
    light.area = static_cast<float>(std::sqrt(dot(span, span)) * to_unit * to_unit);
    light.radius = static_cast<float>(std::sqrt(static_cast<double>(light.area)));
  }
  set_bounds(light);
  if (!spec.color)
    light.color = color_for(light, Sky{}.sun_light * std::numbers::pi_v<float>, 0.25f);
  else if (spec.kind == LightKind::kPoint)
    light.color = *spec.color * static_cast<float>(to_unit * to_unit);
  else
    light.color = *spec.color;
  return light;
}

}  // namespace voxdag
