#pragma once
/// The light that surfaces with a metallic and a roughness number mirror, by samples of the sky.
///
/// No rays are cast: the mirrored light is that of the sky alone, times the part of it that reaches
/// the surface (ambient occlusion). Surfaces mirror no other surfaces: path_light.hpp casts rays.
#include "voxdag/render/microfacet.hpp"
#include "voxdag/render/render_setup.hpp"
#include "voxdag/render/surface_point.hpp"
#include "voxdag/render/tile.hpp"

namespace voxdag {

/// The facets that stand for all those of a view: points of the table of hemispheres.
struct FacetSamples {
  static constexpr int kCount = MicrofacetRule::kSamples;

  FacetView view;
  const HemisphereSample* points = nullptr;  ///< kCount of them.
  PixelSamples pixel;

  VOXDAG_HD MirroredRay ray(int i) const {
    const Point2f disc = pixel.rotated({points[i].direction.x, points[i].direction.y});
    return mirrored_ray(view, disc.x, disc.y);
  }
  VOXDAG_HD MirroredParts parts() const {
    MirroredParts parts;
    for (int i = 0; i < kCount; ++i) parts.add(ray(i));
    parts.all *= 1.0f / kCount;
    parts.fresnel *= 1.0f / kCount;
    return parts;
  }
  /// Returns the direction of a ray in the world. One into the surface itself, whose normal `face`
  /// may differ from that of the view, is mirrored there.
  VOXDAG_HD Vec3f direction(const MirroredRay& ray, Vec3f face) const {
    const Vec3f d = ray.direction;
    const Vec3f direction = view.x * d.x + view.y * d.y + view.z * d.z;
    const float above = dot(direction, face);
    return above < 0 ? direction - face * (2 * above) : direction;
  }
};

/// Returns the facets of a view sample; `first` is the place of their points in a set of the table.
/// `to_viewer` has unit length.
VOXDAG_HD inline FacetSamples facet_samples(const RenderSetup& setup, const ViewSample& sample,
                                            Vec3f to_viewer, const PixelSamples& pixel, int first) {
  const float roughness = sample.metallic_roughness.roughness;
  return {facet_view(sample.normal, to_viewer, roughness * roughness),
          setup.tables.hemisphere + pixel.set * setup.tables.hemisphere_count + first, pixel};
}

/// Returns the parts that the surface of a view sample mirrors, and adds the sky's light that it
/// mirrors to `sky`, if that is not null. `to_viewer` has unit length; `x` and `y` are the pixel.
VOXDAG_HD inline MirroredParts sample_mirror(const RenderSetup& setup, const ViewSample& sample,
                                             Vec3f to_viewer, int x, int y, int sample_index,
                                             Vec3f* sky) {
  // The purposes before are those of occlusion and of the lights.
  const PixelSamples pixel = pixel_samples(setup.tables, x, y, 1 + RenderSetup::kMaxLights);
  const FacetSamples facets =
      facet_samples(setup, sample, to_viewer, pixel, sample_index * FacetSamples::kCount);
  const MirroredParts parts = facets.parts();
  if (sky == nullptr) return parts;
  for (int i = 0; i < FacetSamples::kCount; ++i) {
    const MirroredRay ray = facets.ray(i);
    if (!(ray.weight > 0)) continue;
    *sky = *sky + sky_radiance(setup.sky, facets.direction(ray, sample.face)) *
                      mirror_color(sample.metallic_roughness, sample.albedo, parts, ray.fresnel) *
                      (ray.weight / FacetSamples::kCount);
  }
  return parts;
}

}  // namespace voxdag
