#pragma once
/// Computes the light from sun and lamps, with hard and soft shadows.
///
/// Source: Kämpe, Sintorn and Assarsson, "High Resolution Sparse Voxel DAGs", SIGGRAPH 2013,
/// section 4: shadow rays run from each view sample to points on the light. A beam from the sample
/// to the light shortens the rays to the interval in which the beam meets anything. If the beam
/// meets nothing, no ray is cast.
#include "voxdag/render/ground.hpp"
#include "voxdag/render/light_beam.hpp"
#include "voxdag/render/light_sample.hpp"
#include "voxdag/render/mirrored_sky.hpp"
#include "voxdag/render/specular.hpp"
#include "voxdag/render/tile.hpp"
#include "voxdag/render/tile_scratch.hpp"
#include "voxdag/render/voxel_view_samples.hpp"
#include "voxdag/trace/scalar_caster.hpp"

namespace voxdag {

/// The samples [begin, begin + count) of each pixel, for light `index`.
struct LightBatch {
  int index = 0, begin = 0, count = 0;
};

/// Sets scratch.active to the pixels that need rays to the light, scratch.intervals for these
/// pixels, and scratch.pixels for all pixels. Returns the number of active pixels.
template <class Nodes, class Scratch>
VOXDAG_HD inline int find_shadowed_pixels(const Nodes& nodes, const RenderSetup& setup, int index,
                                          const ViewTile& tile, Scratch& scratch) {
  const Light& light = setup.lights[index];
  int active = 0;
  for (int pixel = 0; pixel < tile.width * tile.height; ++pixel) {
    const SurfacePoint& point = scratch.points[pixel];
    if (!point.is_hit()) continue;
    scratch.pixels[pixel] = pixel_samples(setup.tables, tile.x + tile.column(pixel),
                                          tile.y + tile.row(pixel), 1 + index);
    scratch.lit[pixel] = scratch.unhindered[pixel] = 0;
    scratch.visible[pixel] = ~std::uint64_t{0};
    if (!setup.settings.shadows) continue;
    const DirectionBounds bounds = directions_to(light, point.start.position);
    if (!reach_above(bounds, point.normal) || !reach_above(bounds, point.face)) continue;
    LightInterval interval = light_interval(light);
    if (setup.settings.beams && light.is_extended() && !(scratch.samples[pixel].ground > 0))
      interval = cast_light_beam(nodes, light, point);
    if (interval.is_clear) continue;
    scratch.intervals[pixel] = interval;
    scratch.active[active++] = pixel;
  }
  return active;
}

/// Casts a batch of the active pixels' shadow rays into scratch.visible.
template <class Caster, class Scratch>
VOXDAG_HD inline void trace_shadow_rays(const Caster& caster, const RenderSetup& setup,
                                        const LightBatch& batch, int active, Scratch& scratch) {
  const Light& light = setup.lights[batch.index];
  for (int i = 0; i < active; ++i) scratch.visible[scratch.active[i]] = 0;
  caster.any(
      active * batch.count,
      [&](int i) {
        const int pixel = scratch.active[i / batch.count];
        const SurfacePoint& point = scratch.points[pixel];
        const LightSample sample = sample_light(setup.tables, light, point, scratch.pixels[pixel],
                                                batch.begin + i % batch.count);
        CastRay ray;
        if (!(sample.weight > 0)) return ray;
        const LightInterval& interval = scratch.intervals[pixel];
        ray.ray = ray_from(setup, scratch.samples[pixel], point, sample.direction, interval.first,
                           interval.last);
        limit_to(setup.section, ray.ray);
        // The ray ends at cells of the size that the picture shows, so that shadows and picture
        // agree.
        ray.stop.at_start = point.cell_side;
        return ray;
      },
      [&](int i, bool is_hit) {
        const std::uint64_t bit = is_hit ? 0 : 1;
        scratch.visible[scratch.active[i / batch.count]] |= bit << (i % batch.count);
      });
}

/// Returns the view of a surface for highlights, whose alpha is at least `least`.
VOXDAG_HD inline FacetView highlight_view(Vec3f normal, Vec3f to_viewer, float roughness,
                                          float least) {
  const float alpha = roughness * roughness;
  return facet_view(normal, to_viewer, alpha > least ? alpha : least);
}

/// Returns the light of a batch's unoccluded samples that a pixel's surface mirrors, summed, per
/// unit of the light's colour.
template <class Scratch>
VOXDAG_HD inline Vec3f microfacet_shine(const RenderSetup& setup, const LightBatch& batch,
                                        Vec3f to_viewer, int x, int y, int sample_index, int pixel,
                                        const Scratch& scratch) {
  const Light& light = setup.lights[batch.index];
  const SurfacePoint& point = scratch.points[pixel];
  const ViewSample& seen = scratch.samples[pixel];
  const MetallicRoughness numbers = seen.metallic_roughness;
  const MirroredParts parts = sample_mirror(setup, seen, to_viewer, x, y, sample_index, nullptr);
  const FacetView view =
      highlight_view(point.normal, to_viewer, numbers.roughness, MicrofacetRule::kLeastAlpha);
  Vec3f shine;
  for (int i = 0; i < batch.count; ++i) {
    if ((scratch.visible[pixel] >> i & 1u) == 0) continue;
    const LightSample sample =
        sample_light(setup.tables, light, point, scratch.pixels[pixel], batch.begin + i);
    if (!(sample.weight > 0)) continue;
    float fresnel = 0;
    const float lobe =
        ggx_lobe(view, normalized(direction_from_surface(light, point, sample)), fresnel);
    shine = shine + mirror_color(numbers, seen.albedo, parts, fresnel) * (lobe * sample.weight);
  }
  return shine;
}

/// Adds the highlights of a batch's unoccluded samples to scratch.highlights. A light has `samples`
/// samples per pixel.
template <class Scratch>
VOXDAG_HD inline void add_highlights(const RenderSetup& setup, const LightBatch& batch, int samples,
                                     const ViewTile& tile, Scratch& scratch) {
  const Light& light = setup.lights[batch.index];
  for (int pixel = 0; pixel < tile.width * tile.height; ++pixel) {
    const SurfacePoint& point = scratch.points[pixel];
    if (!point.is_hit()) continue;
    const ViewSample& seen = scratch.samples[pixel];
    const Vec3d view = normalized(pixel_direction(setup, tile, pixel));
    if (!is_dull(seen.metallic_roughness)) {
      const Vec3f shine =
          microfacet_shine(setup, batch, -static_cast<Vec3f>(view), tile.x + tile.column(pixel),
                           tile.y + tile.row(pixel), tile.sample_index, pixel, scratch);
      scratch.highlights[pixel] =
          scratch.highlights[pixel] + light.color * shine * (1 / static_cast<float>(samples));
      continue;
    }
    if (!setup.settings.specular.is_on()) continue;
    const Vec3f mirrored = mirrored_view(-static_cast<Vec3f>(view), point.normal);
    float shine = 0;
    for (int i = 0; i < batch.count; ++i) {
      if ((scratch.visible[pixel] >> i & 1u) == 0) continue;
      const LightSample sample =
          sample_light(setup.tables, light, point, scratch.pixels[pixel], batch.begin + i);
      if (!(sample.weight > 0)) continue;
      const Vec3f to_light = normalized(direction_from_surface(light, point, sample));
      shine += sample.weight * phong_lobe(setup.settings.specular, mirrored, to_light);
    }
    scratch.highlights[pixel] =
        scratch.highlights[pixel] + light.color * (shine / static_cast<float>(samples));
  }
}

/// Adds the light of light `index` to scratch.irradiance, scratch.highlights (if they are on),
/// scratch.lit_sum and scratch.unhindered_sum. Returns the number of rays.
template <class Nodes, class Caster, class Scratch>
VOXDAG_HD inline int trace_light(const Nodes& nodes, const Caster& caster, const RenderSetup& setup,
                                 int index, const ViewTile& tile, Scratch& scratch) {
  constexpr int kBatch = 64;  // samples; scratch.visible has a bit for each
  const Light& light = setup.lights[index];
  const int samples = light.is_extended() ? setup.settings.light_samples : 1;
  const int begin = light.is_extended() ? tile.sample_index * samples : 0;
  const int active = find_shadowed_pixels(nodes, setup, index, tile, scratch);
  for (int done = 0; done < samples; done += kBatch) {
    const LightBatch batch{index, begin + done, samples - done < kBatch ? samples - done : kBatch};
    if (active > 0) trace_shadow_rays(caster, setup, batch, active, scratch);
    if (setup.has_highlights()) add_highlights(setup, batch, samples, tile, scratch);
    for (int pixel = 0; pixel < tile.width * tile.height; ++pixel) {
      const SurfacePoint& point = scratch.points[pixel];
      if (!point.is_hit()) continue;
      for (int i = 0; i < batch.count; ++i) {
        const float weight =
            sample_light(setup.tables, light, point, scratch.pixels[pixel], batch.begin + i).weight;
        scratch.unhindered[pixel] += weight;
        scratch.lit[pixel] += (scratch.visible[pixel] >> i & 1u) != 0 ? weight : 0.0f;
      }
    }
  }
  const float scale = 1.0f / static_cast<float>(samples);
  for (int pixel = 0; pixel < tile.width * tile.height; ++pixel) {
    if (!scratch.points[pixel].is_hit()) continue;
    scratch.irradiance[pixel] =
        scratch.irradiance[pixel] + light.color * (scratch.lit[pixel] * scale);
    const float bright = luminance(light.color) * scale;
    scratch.lit_sum[pixel] += scratch.lit[pixel] * bright;
    scratch.unhindered_sum[pixel] += scratch.unhindered[pixel] * bright;
  }
  return active * samples;
}

}  // namespace voxdag
