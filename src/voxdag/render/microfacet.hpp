#pragma once
/// Surfaces with a metallic and a roughness number: the material model of glTF 2.0, appendix B.
///
/// A metal mirrors light with the tint of its colour. Another surface mirrors 4% of the light from
/// straight above, and is diffuse below. Microfacets mirror: the distribution is GGX with
/// alpha = roughness², their shadowing Smith's, their Fresnel term Schlick's. What one reflection
/// loses between rough facets is added in proportion (E. Turquin, "Practical Multiple Scattering
/// Compensation for Microfacet Models", 2019), so that a white surface reflects all light that
/// arrives from everywhere, whatever its numbers.
///
/// The mirrored sky is sampled: facets that the viewer sees are chosen at random (E. Heitz,
/// "Sampling the GGX Distribution of Visible Normals", JCGT 7(4), 2018). Only products, sums,
/// quotients and square roots are used, so that every device gets the same bits.
#include <cmath>
#include <numbers>

#include "voxdag/core/metallic_roughness.hpp"
#include "voxdag/render/basis.hpp"

namespace voxdag {

struct MicrofacetRule {
  static constexpr float kF0 = 0.04f;  ///< Mirrored part from straight above, without metal.
  /// The least alpha of highlights, so that those of the sun are not smaller than pixels.
  static constexpr float kLeastAlpha = 0.02f;
  /// The least alpha of highlights that a path sees from a diffuse surface: caustics are blurred,
  /// so that few paths do not show them as bright dots.
  static constexpr float kCausticAlpha = 0.3f;
  /// The least cosine between normal and viewer: fitted normals may turn away.
  static constexpr float kLeastCosine = 0.05f;
  static constexpr int kSamples = 16;  ///< Directions of the mirrored sky per view sample.
};

/// Returns whether a surface is diffuse alone: metallic 0 and roughness 1, the defaults.
VOXDAG_HD constexpr bool is_dull(MetallicRoughness numbers) {
  return numbers.metallic <= 0 && numbers.roughness >= 1;
}

/// Returns the part of the light that Schlick's approximation mirrors, besides that of f0: the
/// factor of 1 - f0.
VOXDAG_HD constexpr float schlick(float cosine) {
  const float rest = cosine < 1 ? 1 - cosine : 0.0f, rest2 = rest * rest;
  return rest2 * rest2 * rest;
}

/// A view of a surface in a frame whose z is the normal; the viewer is at y = 0, x >= 0.
struct FacetView {
  Vec3f x, y, z;   ///< The frame's axes, in the world.
  Vec3f viewer{};  ///< In the frame; unit length.
  float alpha = 1;
};

VOXDAG_HD inline FacetView facet_view(Vec3f normal, Vec3f to_viewer, float alpha) {
  FacetView view;
  const float cosine = dot(normal, to_viewer);
  view.z = normal;
  view.x = normalized_or(to_viewer - normal * cosine, make_basis(normal).u);
  view.y = cross(normal, view.x);
  const float up = cosine > MicrofacetRule::kLeastCosine ? cosine : MicrofacetRule::kLeastCosine;
  view.viewer = {std::sqrt(up < 1 ? 1 - up * up : 0.0f), 0, up};
  view.alpha = alpha;
  return view;
}

/// Returns Smith's Lambda of GGX for a direction with this cosine, above 0, to the normal.
VOXDAG_HD inline float smith_lambda(float cosine, float alpha) {
  const float tangent2 = (1 - cosine * cosine) / (cosine * cosine);
  return 0.5f * (std::sqrt(1 + alpha * alpha * (tangent2 > 0 ? tangent2 : 0.0f)) - 1);
}

/// A direction in which a facet mirrors the line of sight.
struct MirroredRay {
  Vec3f direction;    ///< In the frame of the view; unit length.
  float weight = 0;   ///< The part of the light from there that is not shadowed; 0: below.
  float fresnel = 0;  ///< schlick() at the facet.
};

/// Returns the ray for a point of the unit disc. Points with uniform density give visible facets.
VOXDAG_HD inline MirroredRay mirrored_ray(const FacetView& view, float disc_x, float disc_y) {
  const Vec3f v = view.viewer;
  const Vec3f stretched = normalized_or(Vec3f{view.alpha * v.x, 0, v.z}, Vec3f{0, 0, 1});
  const float half = 0.5f * (1 + stretched.z);
  const float edge2 = 1 - disc_x * disc_x;
  const float edge = std::sqrt(edge2 > 0 ? edge2 : 0.0f);
  const float t = (1 - half) * edge + half * disc_y;
  const float up2 = edge2 - t * t;
  const float up = std::sqrt(up2 > 0 ? up2 : 0.0f);
  // The axes of the disc are y, and stretched × y.
  const Vec3f facet = normalized_or(Vec3f{view.alpha * (up * stretched.x - t * stretched.z),
                                          view.alpha * disc_x, up * stretched.z + t * stretched.x},
                                    Vec3f{0, 0, 1});
  MirroredRay ray;
  const float cosine = dot(v, facet);
  ray.direction = facet * (2 * cosine) - v;
  if (!(ray.direction.z > 0)) return ray;
  const float towards = smith_lambda(v.z, view.alpha);
  ray.weight = (1 + towards) / (1 + towards + smith_lambda(ray.direction.z, view.alpha));
  ray.fresnel = schlick(cosine);
  return ray;
}

/// The parts of light that a surface mirrors, without its metal's tint, from sums over rays.
struct MirroredParts {
  float all = 0;      ///< Of white metal: what one reflection does not lose.
  float fresnel = 0;  ///< The part of `all` that does not depend on f0.

  VOXDAG_HD void add(const MirroredRay& ray) {
    all += ray.weight;
    fresnel += ray.weight * ray.fresnel;
  }
  /// Returns the factor that makes up for the lost light.
  VOXDAG_HD float gain(float f0) const { return all > 0 ? 1 + f0 * (1 / all - 1) : 1.0f; }
  /// Returns the part of the light from everywhere that a surface mirrors.
  VOXDAG_HD float mirrored(float f0) const { return (f0 * all + (1 - f0) * fresnel) * gain(f0); }
};

/// Returns the factor of the diffuse light.
VOXDAG_HD inline Vec3f diffuse_albedo(MetallicRoughness numbers, Vec3f color,
                                      const MirroredParts& parts) {
  return color * ((1 - numbers.metallic) * (1 - parts.mirrored(MicrofacetRule::kF0)));
}

/// Returns the factor of light that a facet mirrors at which schlick() is `fresnel`.
VOXDAG_HD inline Vec3f mirror_color(MetallicRoughness numbers, Vec3f color,
                                    const MirroredParts& parts, float fresnel) {
  constexpr float kF0 = MicrofacetRule::kF0;
  const float other = (1 - numbers.metallic) * parts.gain(kF0) * (kF0 + (1 - kF0) * fresnel);
  Vec3f result;
  for (int c = 0; c < 3; ++c)
    result[c] =
        other + numbers.metallic * parts.gain(color[c]) * (color[c] + (1 - color[c]) * fresnel);
  return result;
}

/// Returns the radiance towards the viewer per irradiance from a light in the direction `to_light`
/// (unit length, world), without mirror_color(). Sets `fresnel` to schlick() at the facet.
VOXDAG_HD inline float ggx_lobe(const FacetView& view, Vec3f to_light, float& fresnel) {
  const Vec3f light{dot(to_light, view.x), dot(to_light, view.y), dot(to_light, view.z)};
  fresnel = 0;
  if (!(light.z > 0)) return 0;
  const Vec3f facet = normalized_or(light + view.viewer, Vec3f{0, 0, 1});
  fresnel = schlick(dot(facet, view.viewer));
  const float a2 = view.alpha * view.alpha;
  // 1 - (1 - a2) z², without cancellation where facets are steep.
  const float across = facet.x * facet.x + facet.y * facet.y;
  const float spread = across + a2 * facet.z * facet.z;
  const float facets = a2 / (std::numbers::pi_v<float> * spread * spread);
  const float shadowed =
      1 / (1 + smith_lambda(view.viewer.z, view.alpha) + smith_lambda(light.z, view.alpha));
  return facets * shadowed / (4 * view.viewer.z * light.z);
}

}  // namespace voxdag
