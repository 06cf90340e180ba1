#pragma once
/// The light of the sky and of other surfaces, by tracing paths: the reference for the pictures.
///
/// The method is unbiased: with more paths the light converges to that of diffuse surfaces of the
/// picture's albedo under the picture's sky, sun and lamps, reflected up to N times. A path starts
/// at a view sample in a direction with cosine-weighted density. Where it leaves the scene, it
/// brings the sky's radiance. Where it meets a surface, it brings the light of the sun and of each
/// lamp there, one shadow ray each, and goes on in a new direction. Source: J. Kajiya, "The
/// Rendering Equation", SIGGRAPH 1986.
///
/// A surface with a metallic and a roughness number (microfacet.hpp) has 17 ways on: 16 random
/// facets that the viewer sees, from which the parts of the mirrored light are taken as for the
/// mirrored sky, and the diffuse one. One is chosen with the probability of the light that it
/// reflects. So a path carries the luminance that the surface reflects of light from everywhere: a
/// white one never loses light. Two things are biased: the light that rough metal gains is taken
/// from 16 facets, and the highlights that rough or diffuse surfaces see (caustics) are blurred as
/// these surfaces spread light.
///
/// The first directions come from the table of occlusion rays. Later ones, and the points on
/// lights, are hashes of pixel, sample, path and bounce, so that every machine traces the same
/// paths.
#include "voxdag/render/ambient_occlusion.hpp"
#include "voxdag/render/direct_light.hpp"
#include "voxdag/render/sky.hpp"

namespace voxdag {

/// Random numbers for one bounce of a path. Each call of next() returns other bits.
class PathRandom {
 public:
  VOXDAG_HD PathRandom(int x, int y, int path, int bounce)
      : state_(hash_bits(hash_bits(hash_bits(hash_bits(static_cast<std::uint32_t>(x)) +
                                             static_cast<std::uint32_t>(y)) +
                                   static_cast<std::uint32_t>(path)) +
                         static_cast<std::uint32_t>(bounce))) {}

  VOXDAG_HD std::uint32_t next() { return state_ = hash_bits(state_ + 0x9E3779B9u); }
  /// Returns a number in (-1,1).
  VOXDAG_HD float next_signed() { return (static_cast<float>(next() >> 8) + 0.5f) * 0x1p-23f - 1; }

 private:
  std::uint32_t state_;
};

/// Returns a direction around (0,0,1) with cosine-weighted density: a point of the unit disc,
/// lifted to the hemisphere (Malley's method).
VOXDAG_HD inline Vec3f cosine_direction(PathRandom& random) {
  constexpr int kTries = 32;  // all fail once in 10^21
  for (int i = 0; i < kTries; ++i) {
    const float x = random.next_signed(), y = random.next_signed();
    const float up2 = 1 - x * x - y * y;
    if (up2 > 0) return {x, y, std::sqrt(up2)};
  }
  return {0, 0, 1};
}

/// A surface with a metallic and a roughness number on a path, and how the path goes on there.
struct PathMirror {
  bool is_on = false;  ///< Otherwise the surface is diffuse alone.
  MetallicRoughness numbers;
  Vec3f color, to_viewer;
  MirroredParts parts;
  /// The direction in which the path goes on, of unit length; zero: that of a diffuse reflection.
  Vec3f direction;
  Vec3f factor;  ///< The part of the light from there that is reflected, by its probability.

  /// Returns whether the path goes on by the diffuse way.
  VOXDAG_HD bool is_diffuse() const { return !is_on || !(dot(direction, direction) > 0); }
  /// Returns the least alpha of highlights that the path meets behind this surface.
  VOXDAG_HD float blur() const {
    return is_diffuse() ? MicrofacetRule::kCausticAlpha : numbers.roughness * numbers.roughness;
  }
};

/// The vertex at which a path is.
struct PathVertex {
  SurfacePoint point;
  SightLine line;         ///< The next line of the path, in world units.
  ViewSample seen;        ///< The surface on that line, once it is cast.
  PathMirror mirror;      ///< At `point`, if surfaces may mirror.
  Vec3f carried;          ///< The part of the radiance from here that arrives at the view sample.
  Vec3f arriving;         ///< Irradiance of the current light's sample.
  bool is_lit = false;    ///< The sample is above the surface.
  float least_alpha = 0;  ///< Of highlights at `point`.
};

/// Arrays for trace_paths(), indexed by the tile's pixel.
template <int kPixels>
struct PathScratch {
  PathVertex vertices[kPixels];
  Vec3f gathered[kPixels];  ///< Radiance that the pixel's paths brought, summed.
};

/// Chooses how a path goes on at the surface of a view sample. `to_viewer` has unit length.
VOXDAG_HD inline PathMirror path_mirror(const RenderSetup& setup, const ViewSample& sample,
                                        Vec3f to_viewer, PathRandom random) {
  PathMirror mirror;
  if (is_dull(sample.metallic_roughness)) return mirror;
  mirror.is_on = true;
  mirror.numbers = sample.metallic_roughness;
  mirror.color = sample.albedo;
  mirror.to_viewer = to_viewer;
  const FacetSamples facets =
      facet_samples(setup, sample, to_viewer, samples_of_hash(setup.tables, random.next()), 0);
  const MirroredParts parts = mirror.parts = facets.parts();
  const auto mirrored_by = [&](const MirroredRay& ray) {
    return mirror_color(mirror.numbers, mirror.color, parts, ray.fresnel) *
           (ray.weight / FacetSamples::kCount);
  };
  const Vec3f diffuse = diffuse_albedo(mirror.numbers, mirror.color, parts);
  float total = luminance(diffuse);
  for (int i = 0; i < FacetSamples::kCount; ++i) total += luminance(mirrored_by(facets.ray(i)));
  float rest = 0.5f * (1 + random.next_signed()) * total - luminance(diffuse);
  if (rest < 0 || !(total > 0)) {
    mirror.factor = luminance(diffuse) > 0 ? diffuse * (total / luminance(diffuse)) : Vec3f{};
    return mirror;
  }
  for (int i = 0; i < FacetSamples::kCount; ++i) {
    const MirroredRay ray = facets.ray(i);
    const Vec3f mirrored = mirrored_by(ray);
    const float share = luminance(mirrored);
    if (!(share > 0)) continue;
    // Rounding may leave some rest after the last one.
    mirror.direction = facets.direction(ray, sample.face);
    mirror.factor = mirrored * (total / share);
    rest -= share;
    if (rest < 0) break;
  }
  return mirror;
}

/// Returns the radiance that the mirror at a vertex reflects along the path, times pi, per
/// irradiance from a light.
VOXDAG_HD inline Vec3f reflected_at(const PathVertex& vertex, Vec3f to_light) {
  const PathMirror& mirror = vertex.mirror;
  float fresnel = 0;
  const float lobe = ggx_lobe(highlight_view(vertex.point.normal, mirror.to_viewer,
                                             mirror.numbers.roughness, vertex.least_alpha),
                              to_light, fresnel);
  return diffuse_albedo(mirror.numbers, mirror.color, mirror.parts) +
         mirror_color(mirror.numbers, mirror.color, mirror.parts, fresnel) *
             (lobe * std::numbers::pi_v<float>);
}

/// Returns the next ray of a path, and sets vertex.line. `path` counts the pixel's paths over all
/// samples.
VOXDAG_HD inline CastRay path_ray(const RenderSetup& setup, const ViewSample& sample,
                                  const PixelSamples& pixel, int x, int y, int path, int bounce,
                                  PathVertex& vertex) {
  const SurfacePoint& point = vertex.point;
  const auto make_ray = [&](Vec3f direction, float /*t_max*/) {
    vertex.line = {setup.grid.origin +
                       (static_cast<Vec3d>(point.start.position) - Vec3d{1, 1, 1}) * setup.side(),
                   static_cast<Vec3d>(direction) * setup.side()};
    GridRay ray = bounce == 0 ? ray_from(setup, sample, point, direction, 0, HUGE_VALF)
                              : make_grid_ray(point.start, direction, 0, HUGE_VALF);
    limit_to(setup.section, ray);
    return ray;
  };
  if (!vertex.mirror.is_diffuse())
    return {make_ray(vertex.mirror.direction, 0), {point.cell_side, 0}};
  if (bounce == 0) return occlusion_ray(setup.tables, 1, 0, point, pixel, path, make_ray);
  PathRandom random(x, y, path, bounce);
  return {make_ray(around_normal(point, cosine_direction(random)), 0), {point.cell_side, 0}};
}

/// Adds the light of light `index` at the vertices of `active` pixels, whose last line ended there
/// after `bounce` bounces, to paths.gathered. Returns the number of rays.
template <class Caster, class Scratch, class Paths>
VOXDAG_HD inline int add_path_light(const Caster& caster, const RenderSetup& setup, int index,
                                    const ViewTile& tile, int path, int bounce, int active,
                                    Scratch& scratch, Paths& paths) {
  const Light& light = setup.lights[index];
  caster.any(
      active,
      [&](int i) {
        const int pixel = scratch.active[i];
        PathVertex& vertex = paths.vertices[pixel];
        PathRandom random(tile.x + tile.column(pixel), tile.y + tile.row(pixel), path,
                          (bounce + 1) * RenderSetup::kMaxLights * 2 + index);
        const std::uint32_t bits = random.next();
        const PixelSamples place = samples_of_hash(setup.tables, bits);
        const LightSample sample = sample_light(
            setup.tables, light, vertex.point, place,
            static_cast<int>(random.next() % static_cast<std::uint32_t>(setup.tables.light_count)));
        vertex.arriving = light.color * sample.weight;
        vertex.is_lit = sample.weight > 0;
        if (vertex.is_lit && vertex.mirror.is_on)
          vertex.arriving =
              vertex.arriving *
              reflected_at(vertex, normalized(direction_from_surface(light, vertex.point, sample)));
        CastRay ray;
        if (!vertex.is_lit || !setup.settings.shadows) return ray;
        const LightInterval interval = light_interval(light);
        ray.ray =
            make_grid_ray(vertex.point.start, sample.direction, interval.first, interval.last);
        limit_to(setup.section, ray.ray);
        ray.stop.at_start = vertex.point.cell_side;
        return ray;
      },
      [&](int i, bool is_hit) {
        const int pixel = scratch.active[i];
        const PathVertex& vertex = paths.vertices[pixel];
        if (is_hit || !vertex.is_lit) return;
        paths.gathered[pixel] =
            paths.gathered[pixel] + vertex.carried * vertex.arriving * kInversePi;
      });
  return active;
}

/// Sets paths.gathered and scratch.open (the paths that leave the scene at once) for the pixels
/// that show something. What arrives is gathered, divided by pi; at mirrors what they reflect of
/// it. Returns the number of rays.
template <class Nodes, class Caster, class Scratch, class Paths>
VOXDAG_HD inline int trace_paths(const Nodes& nodes, const Caster& caster, const RenderSetup& setup,
                                 const ViewTile& tile, Scratch& scratch, Paths& paths) {
  const int pixels = tile.width * tile.height, count = setup.settings.occlusion_samples;
  for (int pixel = 0; pixel < pixels; ++pixel) {
    scratch.open[pixel] = 0;
    paths.gathered[pixel] = {};
    scratch.pixels[pixel] =
        pixel_samples(setup.tables, tile.x + tile.column(pixel), tile.y + tile.row(pixel), 0);
  }
  const auto random_of = [&](int pixel, int path, int bounce) {
    // Directions and lights have the numbers from 0 on.
    return PathRandom(tile.x + tile.column(pixel), tile.y + tile.row(pixel), path, -1 - bounce);
  };
  const bool has_mirrors = setup.has_mirrors();
  int rays = 0;
  for (int k = 0; k < count; ++k) {
    const int path = tile.sample_index * count + k;
    int active = 0;
    for (int pixel = 0; pixel < pixels; ++pixel) {
      if (!scratch.points[pixel].is_hit()) continue;
      PathVertex& vertex = paths.vertices[pixel];
      vertex.point = scratch.points[pixel];
      vertex.carried = {1, 1, 1};
      vertex.mirror = {};
      vertex.least_alpha = MicrofacetRule::kLeastAlpha;
      if (has_mirrors) {
        const Vec3d view = normalized(pixel_direction(setup, tile, pixel));
        vertex.mirror = path_mirror(setup, scratch.samples[pixel], -static_cast<Vec3f>(view),
                                    random_of(pixel, path, 0));
        if (vertex.mirror.is_on) vertex.carried = vertex.mirror.factor;
      }
      scratch.active[active++] = pixel;
    }
    for (int bounce = 0; active > 0; ++bounce) {
      caster.closest(
          active,
          [&](int i) {
            const int pixel = scratch.active[i];
            return path_ray(setup, scratch.samples[pixel], scratch.pixels[pixel],
                            tile.x + tile.column(pixel), tile.y + tile.row(pixel), path, bounce,
                            paths.vertices[pixel]);
          },
          [&](int i, const GridRay& ray, const typename FoundBy<Nodes>::Type& cell, bool is_hit) {
            PathVertex& vertex = paths.vertices[scratch.active[i]];
            vertex.seen = {};
            if (!is_hit) return;
            const Vec3d away = vertex.line.origin - setup.camera.eye +
                               vertex.line.direction * ray.to_world_t(static_cast<double>(cell.t));
            FreshLayers layers;  // Paths of neighbours part.
            vertex.seen =
                view_sample_of(nodes, setup, vertex.line, ray, cell, length(away), layers);
          });
      rays += active;
      int left = 0;
      for (int i = 0; i < active; ++i) {
        const int pixel = scratch.active[i];
        PathVertex& vertex = paths.vertices[pixel];
        if (!vertex.seen.is_hit()) {
          if (bounce == 0) ++scratch.open[pixel];
          const auto out = static_cast<Vec3f>(normalized(vertex.line.direction));
          paths.gathered[pixel] =
              paths.gathered[pixel] + vertex.carried * sky_radiance(setup.sky, out);
        } else if (bounce < setup.settings.bounces) {
          vertex.point = make_surface_point(nodes, setup, vertex.seen, vertex.line);
          const float blur = vertex.mirror.blur();
          if (blur > vertex.least_alpha) vertex.least_alpha = blur;
          if (has_mirrors)
            vertex.mirror = path_mirror(setup, vertex.seen,
                                        -static_cast<Vec3f>(normalized(vertex.line.direction)),
                                        random_of(pixel, path, bounce + 1));
          if (!vertex.mirror.is_on) vertex.carried = vertex.carried * vertex.seen.albedo;
          scratch.active[left++] = pixel;
        }
      }
      active = left;
      for (int light = 0; light < setup.light_count && active > 0; ++light)
        rays += add_path_light(caster, setup, light, tile, path, bounce, active, scratch, paths);
      for (int i = 0; i < active && has_mirrors; ++i) {
        PathVertex& vertex = paths.vertices[scratch.active[i]];
        if (vertex.mirror.is_on) vertex.carried = vertex.carried * vertex.mirror.factor;
      }
    }
  }
  return rays;
}

}  // namespace voxdag
