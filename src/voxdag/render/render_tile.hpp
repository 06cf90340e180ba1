#pragma once
/// Renders a tile of a picture in stages: view samples, the light of each lamp, occlusion, shading.
/// Each stage but shading casts one long stream of rays.
///
/// Every value depends on its pixel alone, and sums have a fixed order. So pictures do not depend
/// on the size of the tiles or on the number of threads.
#include "voxdag/render/ambient_occlusion.hpp"
#include "voxdag/render/cell_pixels.hpp"
#include "voxdag/render/direct_light.hpp"
#include "voxdag/render/ground.hpp"
#include "voxdag/render/path_light.hpp"
#include "voxdag/render/voxel_view_samples.hpp"

namespace voxdag {

/// Returns the part of the sky's light that arrives at a surface. `open` is the fraction of light
/// that is not occluded, 0 to 1.
VOXDAG_HD inline float sky_part(const RenderSetup& setup, const ViewSample& sample, Vec3f view,
                                float open) {
  if (setup.settings.occlusion_samples > 0) return SkyShape::kOpen * open;
  // Without occlusion, shadows that only the sky lights would look flat. Soft light from the viewer
  // and from the viewer's right shows their shape.
  const float facing = dot(sample.normal, view), aside = dot(sample.normal, setup.sky.fill);
  const float fill =
      SkyShape::kFill + SkyShape::kFillFacing * facing + SkyShape::kFillAside * aside;
  return fill > 0 ? fill : 0.0f;
}

/// Returns the radiance of a surface with a metallic and a roughness number. `ambient` is the light
/// that comes neither from sun nor lamps, divided by pi, `part` the part of the sky's light that
/// arrives, `lit` the light of sun and lamps, divided by pi, and `highlights` what they mirror. If
/// the light bounces, `ambient` is what the surface reflects of the first light.
VOXDAG_HD inline Vec3f mirror_radiance(const RenderSetup& setup, const ViewTile& tile, int pixel,
                                       const ViewSample& sample, Vec3f ambient, float part,
                                       Vec3f lit, Vec3f highlights) {
  const Vec3f view = static_cast<Vec3f>(normalized(pixel_direction(setup, tile, pixel)));
  const bool is_traced = setup.settings.bounces >= 0;
  Vec3f sky;
  const MirroredParts parts =
      sample_mirror(setup, sample, -view, tile.x + tile.column(pixel), tile.y + tile.row(pixel),
                    tile.sample_index, is_traced ? nullptr : &sky);
  if (is_traced)
    return lit * diffuse_albedo(sample.metallic_roughness, sample.albedo, parts) + ambient +
           highlights;
  return (ambient + lit) * diffuse_albedo(sample.metallic_roughness, sample.albedo, parts) +
         sky * part + highlights;
}

/// Shades the tile's view samples and adds them to the picture. `ambient(pixel, part)` returns the
/// light that comes neither from sun nor lamps, divided by pi, and `part_of(pixel, open)` the part
/// of the sky's light that arrives.
template <class Scratch, class Ambient, class Part>
VOXDAG_HD inline void shade_tile(const RenderSetup& setup, const ViewTile& tile,
                                 const Scratch& scratch, const Ambient& ambient,
                                 const Part& part_of) {
  const RenderSettings& settings = setup.settings;
  const ImageBuffers& image = setup.image;
  const float share = 1.0f / static_cast<float>(settings.samples_per_pixel);
  for (int pixel = 0; pixel < tile.width * tile.height; ++pixel) {
    const int x = tile.x + tile.column(pixel), y = tile.y + tile.row(pixel);
    const std::size_t at =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(setup.camera.width) +
        static_cast<std::size_t>(x);
    const ViewSample& sample = scratch.samples[pixel];
    const bool is_hit = scratch.points[pixel].is_hit();
    float open = 1, lit = 1, covered = is_hit ? 1.0f : 0.0f;
    Vec3f radiance;
    if (sample.ground > 0) {
      const float sky = settings.occlusion_samples > 0
                            ? static_cast<float>(scratch.open[pixel]) /
                                  static_cast<float>(settings.occlusion_samples)
                            : 1.0f;
      covered =
          ground_shadow(setup, sample, sky, scratch.lit_sum[pixel], scratch.unhindered_sum[pixel]);
    } else if (is_hit) {
      if (settings.occlusion_samples > 0)
        open = static_cast<float>(scratch.open[pixel]) /
               static_cast<float>(settings.occlusion_samples);
      if (scratch.unhindered_sum[pixel] > 0)
        lit = scratch.lit_sum[pixel] / scratch.unhindered_sum[pixel];
      const float part = part_of(pixel, open);
      const Vec3f lit_sky = ambient(pixel, part), direct = scratch.irradiance[pixel] * kInversePi;
      if (setup.has_mirrors() && !is_dull(sample.metallic_roughness)) {
        radiance = mirror_radiance(setup, tile, pixel, sample, lit_sky, part, direct,
                                   scratch.highlights[pixel]);
      } else {
        radiance = (lit_sky + direct) * sample.albedo;
        if (settings.specular.is_on()) radiance = radiance + scratch.highlights[pixel];
      }
    }
    const bool is_first = tile.sample_index == 0;
    const auto add = [&](auto* values, auto value) {
      if (values != nullptr) values[at] = is_first ? value * share : values[at] + value * share;
    };
    add(image.radiance, radiance);
    add(image.coverage, covered);
    add(image.occlusion, open);
    add(image.shadow, lit);
    const bool is_surface = is_hit && !(sample.ground > 0);
    if (is_first && image.depth != nullptr) image.depth[at] = is_surface ? sample.depth : HUGE_VALF;
    if (is_first && image.normal != nullptr)
      image.normal[at] = is_surface ? sample.normal : Vec3f{};
    if (is_first && image.albedo != nullptr)
      image.albedo[at] = is_surface ? sample.albedo : Vec3f{};
    if (is_first && image.cells != nullptr) image.cells[at] = sample.cell;
    if (is_first && image.cell_pixels != nullptr) {
      const double side = setup.camera.pixel_size() * static_cast<double>(sample.depth);
      image.cell_pixels[at] = pack_cell_pixels(
          is_surface ? static_cast<float>(static_cast<double>(sample.cell_size) / side) : 0.0f);
    }
  }
}

/// Renders sample tile.sample_index of the tile's pixels (see set_sample) and returns the number of
/// rays. `find_samples(tile, scratch)` sets scratch.samples and returns the number of rays that it
/// cast; for pictures of voxels it is trace_view_samples(). A pixel's samples must come in order.
template <class Nodes, class Caster, class Scratch, class FindSamples>
VOXDAG_HD inline int render_sample(const Nodes& nodes, const Caster& caster,
                                   const RenderSetup& setup, const ViewTile& tile, Scratch& scratch,
                                   const FindSamples& find_samples) {
  int rays = find_samples(tile, scratch);
  for (int pixel = 0; pixel < tile.width * tile.height; ++pixel) {
    ViewSample& sample = scratch.samples[pixel];
    scratch.points[pixel] = {};
    if (!sample.is_hit() && setup.ground.radius > 0)
      sample = ground_view_sample(setup, pixel_direction(setup, tile, pixel));
    if (sample.ground > 0)
      scratch.points[pixel] = ground_point(setup, sample);
    else if (sample.is_hit())
      scratch.points[pixel] =
          make_surface_point(nodes, setup, sample, pixel_line(setup, tile, pixel));
    scratch.irradiance[pixel] = {};
    if (setup.has_highlights()) scratch.highlights[pixel] = {};
    scratch.lit_sum[pixel] = scratch.unhindered_sum[pixel] = 0;
  }
  for (int light = 0; light < setup.light_count; ++light)
    rays += trace_light(nodes, caster, setup, light, tile, scratch);
  if constexpr (Scratch::kWithPaths) {
    if (setup.settings.bounces >= 0) {
      rays += trace_paths(nodes, caster, setup, tile, scratch, scratch.paths);
      const float share = 1.0f / static_cast<float>(setup.settings.occlusion_samples);
      shade_tile(
          setup, tile, scratch,
          [&](int pixel, float /*part*/) { return scratch.paths.gathered[pixel] * share; },
          [](int /*pixel*/, float open) { return open; });
      return rays;
    }
  }
  if (setup.settings.occlusion_samples > 0) rays += trace_occlusion(caster, setup, tile, scratch);
  shade_tile(
      setup, tile, scratch,
      [&](int pixel, float part) {
        return sky_ambient(setup.sky, scratch.samples[pixel].normal) * part;
      },
      [&](int pixel, float open) {
        const Vec3d direction = normalized(pixel_direction(setup, tile, pixel));
        return sky_part(setup, scratch.samples[pixel], -static_cast<Vec3f>(direction), open);
      });
  return rays;
}

/// Renders all samples of a tile's pixels and returns the number of rays.
template <class Nodes, class Caster, class Scratch, class FindSamples>
VOXDAG_HD inline int render_tile(const Nodes& nodes, const Caster& caster, const RenderSetup& setup,
                                 ViewTile tile, Scratch& scratch, const FindSamples& find_samples) {
  int rays = 0;
  for (int i = 0; i < setup.settings.samples_per_pixel; ++i) {
    set_sample(tile, i);
    rays += render_sample(nodes, caster, setup, tile, scratch, find_samples);
  }
  return rays;
}

}  // namespace voxdag
