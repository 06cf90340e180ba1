#pragma once
/// The light that surfaces with a metallic and a roughness number mirror, by samples of the sky.
///
/// No rays are cast: the mirrored light is that of the sky alone, times the part of it that reaches
/// the surface (ambient occlusion). Surfaces mirror no other surfaces.
#include "voxdag/render/microfacet.hpp"
#include "voxdag/render/render_setup.hpp"
#include "voxdag/render/surface_point.hpp"
#include "voxdag/render/tile.hpp"

namespace voxdag {

/// Returns the parts that the surface of a view sample mirrors, and adds the sky's light that it
/// mirrors to `sky`, if that is not null. `to_viewer` has unit length; `x` and `y` are the pixel.
VOXDAG_HD inline MirroredParts sample_mirror(const RenderSetup& setup, const ViewSample& sample,
                                             Vec3f to_viewer, int x, int y, int sample_index,
                                             Vec3f* sky) {
  constexpr int kSamples = MicrofacetRule::kSamples;
  const MetallicRoughness numbers = sample.metallic_roughness;
  const FacetView view =
      facet_view(sample.normal, to_viewer, numbers.roughness * numbers.roughness);
  // The purposes before are those of occlusion and of the lights.
  const PixelSamples pixel = pixel_samples(setup.tables, x, y, 1 + RenderSetup::kMaxLights);
  const auto ray_of = [&](int i) {
    const HemisphereSample& point =
        setup.tables
            .hemisphere[pixel.set * setup.tables.hemisphere_count + sample_index * kSamples + i];
    const Point2f disc = pixel.rotated({point.direction.x, point.direction.y});
    return mirrored_ray(view, disc.x, disc.y);
  };
  MirroredParts parts;
  for (int i = 0; i < kSamples; ++i) parts.add(ray_of(i));
  parts.all *= 1.0f / kSamples;
  parts.fresnel *= 1.0f / kSamples;
  if (sky == nullptr) return parts;
  for (int i = 0; i < kSamples; ++i) {
    const MirroredRay ray = ray_of(i);
    if (!(ray.weight > 0)) continue;
    const Vec3f d = ray.direction;
    Vec3f direction = view.x * d.x + view.y * d.y + view.z * d.z;
    // A direction into the surface itself, whose normal may differ, is mirrored there.
    if (const float above = dot(direction, sample.face); above < 0)
      direction = direction - sample.face * (2 * above);
    *sky = *sky + sky_radiance(setup.sky, direction) *
                      mirror_color(numbers, sample.albedo, parts, ray.fresnel) *
                      (ray.weight / kSamples);
  }
  return parts;
}

}  // namespace voxdag
