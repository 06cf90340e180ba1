#include "voxdag/render/render_plan.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "voxdag/core/error.hpp"
#include "voxdag/core/parallel/parallel_for.hpp"
#include "voxdag/render/coarse_cells.hpp"
#include "voxdag/render/exposure.hpp"
#include "voxdag/render/hatch.hpp"
#include "voxdag/render/microfacet.hpp"
#include "voxdag/render/tone_map.hpp"

namespace voxdag {
namespace {

/// Returns the options. Throws Error if one is out of range.
const RenderOptions& checked(const RenderOptions& options) {
  constexpr int kMaxSide = 1 << 16, kMaxSamples = 1 << 16;
  if (options.width < 1 || options.height < 1 || options.width > kMaxSide ||
      options.height > kMaxSide)
    throw Error("a picture must have 1 to 65536 pixels a side");
  if (options.samples_per_pixel < 1 || options.samples_per_pixel > kMaxSamples)
    throw Error("a picture must have 1 to 65536 samples per pixel");
  if (options.shadow_samples < 1 || options.shadow_samples > kMaxSamples)
    throw Error("soft shadows must have 1 to 65536 rays per pixel");
  if (options.occlusion_samples < 0 || options.occlusion_samples > kMaxSamples)
    throw Error("ambient occlusion must have 0 to 65536 rays per pixel");
  if (!(options.specular.strength >= 0 && options.specular.strength <= 1))
    throw Error("the strength of highlights must be 0 to 1");
  if (options.specular.exponent < 1 || options.specular.exponent > 10'000)
    throw Error("the exponent of highlights must be 1 to 10000");
  if (!(options.occlusion_distance >= 0 && options.occlusion_distance < HUGE_VAL))
    throw Error("the distance of ambient occlusion must be finite and not negative");
  if (!(options.occlusion_cone >= 0 && options.occlusion_cone < 2 * std::numbers::pi))
    throw Error("the solid angle of occlusion cones must be at least 0 and below 2 pi steradians");
  if (options.bounces && (*options.bounces < 0 || *options.bounces > RenderLimits::kBounces))
    throw Error("light must bounce 0 to 64 times");
  if (options.bounces && options.occlusion_samples == 0)
    throw Error("light that bounces needs at least one occlusion ray per pixel");
  if (!(options.sun_degrees >= 0 && options.sun_degrees < 90))
    throw Error("the sun's angle must be at least 0 and below 90 degrees");
  if (!std::isfinite(options.environment_degrees))
    throw Error("the turn of the environment must be finite");
  if (!(options.sky >= 0 && options.sky < HUGE_VALF))
    throw Error("the sky's factor must be finite and not negative");
  if (options.lights.size() >= RenderSetup::kMaxLights)
    throw Error("a picture can have at most 15 lights besides the sun");
  if (options.tile_size < 1 || options.tile_size > 32)
    throw Error("tiles must have 1 to 32 pixels a side");
  return options;
}

/// Returns the number of rays per view sample, for `per_pixel` rays in a pixel with
/// `samples_per_pixel` view samples.
int per_view_sample(int per_pixel, int samples_per_pixel) {
  return (per_pixel + samples_per_pixel - 1) / samples_per_pixel;
}

/// Returns the look with what kernels read of its channels.
LookView look_of_picture(const RenderOptions& options) {
  LookView look = options.look;
  MetallicRoughnessView& numbers = look.dag.metallic_roughness;
  if (!options.reflections)
    numbers = {};
  else if (numbers.is_empty())  // else they lie on the device
    numbers = metallic_roughness_of(look.dag.attributes.channels);
  return look;
}

/// Returns sample sets for the rays of a pixel: as many for each view sample.
SampleSets make_samples(const RenderOptions& options) {
  const int view_samples = options.samples_per_pixel;
  const int light_rays = view_samples * per_view_sample(options.shadow_samples, view_samples);
  const int occlusion_rays =
      view_samples * per_view_sample(options.occlusion_samples, view_samples);
  const int mirrored_rays = look_of_picture(options).dag.metallic_roughness.is_empty()
                                ? 1
                                : view_samples * MicrofacetRule::kSamples;
  return {light_rays, std::max(mirrored_rays, occlusion_rays)};
}

/// Returns the mean luminance of the clear sky and the ground.
float clear_luminance() {
  const Sky sky;
  return luminance(sky_ambient(sky, sky.up) + sky_ambient(sky, -sky.up)) / 2;
}

/// Returns the direction towards the environment's sun in the world, or up if it has none.
Vec3d sun_of(const Environment& environment, const SkyMap& map) {
  const Vec3f at = environment.sun_direction();
  const Vec3f sun = map.right * at.x + map.up * at.y + map.back * at.z;
  return static_cast<Vec3d>(dot(sun, sun) > 0 ? sun : map.up);
}

/// Returns the irradiance of a surface that faces the sun; nothing for the default, zero if there
/// is no sun.
std::optional<Vec3f> sun_color(const RenderOptions& options) {
  if (!options.environment) return std::nullopt;
  const Vec3f color = options.environment->sun_irradiance();
  if (dot(color, color) > 0 || !options.sun) return color;
  // The sun of the clear sky, in the units of the environment.
  return Sky{}.sun_light *
         (std::numbers::pi_v<float> * options.environment->mean_luminance() / clear_luminance());
}

/// Returns the sky with the sun's direction. The default direction shows the shapes in view well.
Sky make_sky(const Camera& camera, const View& view, const RenderOptions& options,
             const std::optional<Vec3d>& interior_sun) {
  Sky sky;
  const Vec3d up = normalized(view.up);
  const Vec3d right = normalized(camera.right);
  const Vec3d back = cross(right, up);
  if (options.environment) {
    sky.map = options.environment->map(static_cast<Vec3f>(up), options.environment_degrees);
    sky.map.scale = options.sky;
  }
  const Vec3d sun = options.sun ? *options.sun
                    : options.environment
                        ? sun_of(*options.environment, sky.map)
                        : interior_sun.value_or(up * kDefaultSun.y + right * kDefaultSun.x +
                                                back * kDefaultSun.z);
  const double length2 = dot(sun, sun);
  if (!(length2 > 0 && length2 < HUGE_VAL))
    throw Error("the direction of the sun must be finite and not zero");
  sky.up = static_cast<Vec3f>(up);
  sky.sun = static_cast<Vec3f>(normalized(sun));
  sky.fill = static_cast<Vec3f>(right);
  sky.zenith = sky.zenith * options.sky;
  sky.horizon = sky.horizon * options.sky;
  sky.ground = sky.ground * options.sky;
  if (!options.with_sun) sky.sun_light = {};
  return sky;
}

/// Returns the ground under the voxels of a DAG; none under an ESVO, or if no axis points up.
Ground make_ground(const VoxelSet& voxels, const Grid& grid, Vec3d up) {
  // The lowest block of a streamed ESVO may not be loaded, and its pictures are those of the whole.
  if (voxels.dag() == nullptr) return {};
  constexpr int kLevel = 7;
  int axis = 0;
  while (axis < 3 && up[axis] != length(up)) ++axis;
  const CoarseCells cells(voxels, kLevel);
  if (axis == 3 || cells.cells().empty()) return {};
  const double cell_size = grid.cell_size(cells.level());
  const Vec3d lo = static_cast<Vec3d>(cells.bounds().lo) * cell_size,
              hi = static_cast<Vec3d>(cells.bounds().hi) * cell_size;
  Ground ground;
  ground.middle = grid.origin + (lo + hi) * 0.5;
  ground.middle[axis] =
      grid.origin[axis] + static_cast<double>(lowest_voxel(voxels, axis)) * grid.voxel_size;
  ground.radius = length(hi - lo);
  return ground;
}

/// Returns the section in the coordinates of rays.
RaySection make_section(const Grid& grid, const SectionOptions& options) {
  RaySection section;
  section.is_on = options.box || options.plane;
  const auto in_grid = [&](Vec3d world) {
    return (world - grid.origin) * (1 / grid.side()) + Vec3d{1, 1, 1};
  };
  if (options.box) {
    const Vec3d low = in_grid(options.box->lo), high = in_grid(options.box->hi);
    for (int axis = 0; axis < 3; ++axis) {
      section.low[axis] = static_cast<float>(std::clamp(low[axis], 1.0, 2.0));
      section.high[axis] = static_cast<float>(std::clamp(high[axis], 1.0, 2.0));
    }
  }
  if (options.plane) {
    section.normal = normalized(options.plane->normal);
    section.height = dot(section.normal, in_grid(options.plane->point));
  }
  return section;
}

}  // namespace

RenderPlan::RenderPlan(const VoxelSet& voxels, const Grid& grid, const RenderOptions& options)
    : samples_(make_samples(checked(options))),
      exposure_(options.exposure),
      tone_(options.tone),
      background_(options.background),
      materials_(options.materials),
      environment_(options.environment) {
  if (options.with_material && !options.materials.attributes.has_materials())
    throw Error("the pass material needs voxels with material ids");
  assert(grid.levels == voxels.levels());
  const std::size_t pixels =
      static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height);
  image_.width = options.width;
  image_.height = options.height;
  image_.view =
      frame_scene(voxels, grid, static_cast<double>(options.width) / options.height, options.view);
  image_.radiance.resize(pixels);
  image_.coverage.resize(pixels);
  image_.depth.resize(pixels);
  const bool is_guided = options.filter == FilterKind::kGuided;
  if (options.with_normal || is_guided) image_.normal.resize(pixels);
  if (options.with_occlusion || is_guided) image_.occlusion.resize(pixels);
  if (options.with_shadow || is_guided) image_.shadow.resize(pixels);
  if (options.with_steps) image_.steps.resize(pixels);
  if (options.with_albedo) image_.albedo.resize(pixels);
  if (options.with_cells || options.with_material) image_.cells.resize(pixels);
  if (options.filter != FilterKind::kNone) image_.cell_pixels.resize(pixels);

  setup_.grid = grid;
  setup_.camera = make_camera(image_.view, options.width, options.height);
  const double aspect = static_cast<double>(options.width) / options.height;
  const bool is_interior = shows_interior(voxels, grid, options.view, image_.view);
  std::optional<Vec3d> sun_inside;
  if (is_interior)
    sun_inside = options.view.home ? options.view.home->sun
                                   : interior_sun(voxels, grid, image_.view, aspect);
  setup_.sky = make_sky(setup_.camera, image_.view, options, sun_inside);
  setup_.tables = samples_.view();
  setup_.look = look_of_picture(options);
  setup_.section = make_section(grid, options.section);
  if (options.ground && !is_interior && !setup_.section.is_on)
    setup_.ground = make_ground(voxels, grid, image_.view.up);
  setup_.image = buffers_of(image_);

  RenderSettings& settings = setup_.settings;
  settings.samples_per_pixel = options.samples_per_pixel;
  settings.shadows = options.shadows;
  settings.light_samples = per_view_sample(options.shadow_samples, options.samples_per_pixel);
  settings.occlusion_samples =
      per_view_sample(options.occlusion_samples, options.samples_per_pixel);
  settings.occlusion_distance =
      static_cast<float>(options.occlusion_distance > 0 ? options.occlusion_distance / setup_.side()
                         : is_interior                  ? kInteriorOcclusion
                                                        : kOcclusionDistance);
  settings.occlusion_cone = static_cast<float>(std::sqrt(options.occlusion_cone));
  settings.bounces = options.bounces.value_or(-1);
  settings.lod_pixels = options.lod_pixels;
  settings.cube_pixels = options.cube_pixels;
  settings.beams = options.beams;
  if (options.section.hatch && setup_.section.is_on)
    settings.hatch_period =
        hatch_period(setup_.camera.pixel_size() * options.height *
                     length(image_.view.target - image_.view.eye) / setup_.side());
  settings.albedo = options.albedo;
  settings.specular = options.specular;

  if (options.with_sun) {
    LightSpec sun;
    sun.kind = LightKind::kSun;
    sun.position = static_cast<Vec3d>(setup_.sky.sun);
    sun.radius = std::tan(options.sun_degrees * std::numbers::pi / 360);
    sun.color = sun_color(options);
    if (!sun.color || dot(*sun.color, *sun.color) > 0)
      setup_.lights[setup_.light_count++] = make_light(sun, grid);
  }
  for (const LightSpec& light : options.lights)
    setup_.lights[setup_.light_count++] = make_light(light, grid);
}

std::uint32_t RenderPlan::material_of(const SeenCell& cell) const {
  const int shift = setup_.grid.levels - cell.level;
  return material_at(materials_,
                     {cell.voxel.x >> shift, cell.voxel.y >> shift, cell.voxel.z >> shift},
                     cell.level);
}

Vec3f RenderPlan::background_at(Vec3f sky) const {
  switch (background_) {
    case Background::kSky:
      // An environment is exposed as if it were as bright as the clear sky.
      return tone_map(
          tone_,
          sky * (ExposureRule::kSky *
                 (environment_ ? clear_luminance() / environment_->mean_luminance() : 1.0f)));
    case Background::kGrey:
      return {kGreyBackground, kGreyBackground, kGreyBackground};
    case Background::kWhite:
      return {1, 1, 1};
    default:
      return {};
  }
}

RenderedImage RenderPlan::finish(RenderedImage image) const {
  constexpr std::size_t kPixelsPerTask = 1 << 14;
  const auto is_mixed = [&](std::size_t i) {
    return image.coverage[i] > 0 && image.coverage[i] < 1;
  };
  parallel_for(image.radiance.size(), kPixelsPerTask, [&](std::size_t i) {
    if (is_mixed(i)) image.radiance[i] = image.radiance[i] * (1 / image.coverage[i]);
  });
  image.exposure = exposure_ > 0 ? exposure_ : automatic_exposure(image.radiance, image.depth);
  if (materials_.attributes.has_materials()) {
    image.material.resize(image.cells.size());
    parallel_for(image.cells.size(), kPixelsPerTask, [&](std::size_t i) {
      const SeenCell& cell = image.cells[i];
      const std::uint32_t id = cell.level < 0 ? kMaxMaterials : material_of(cell);
      image.material[i] = id == kMaxMaterials ? -1.0f : static_cast<float>(id);
    });
  }
  image.has_alpha = background_ == Background::kTransparent;
  image.rgb.resize(image.radiance.size());
  parallel_for(image.rgb.size(), kPixelsPerTask, [&](std::size_t i) {
    const float coverage = image.coverage[i];
    if (coverage > 0) image.rgb[i] = tone_map(tone_, image.radiance[i] * image.exposure);
    if (coverage >= 1) return;
    const auto width = static_cast<std::size_t>(image.width);
    const Vec3d ray = setup_.camera.direction(static_cast<double>(i % width) + 0.5,
                                              static_cast<double>(i / width) + 0.5);
    const Vec3f sky = sky_radiance(setup_.sky, static_cast<Vec3f>(normalized(ray)));
    // Surfaces and background are exposed apart, then mixed as light of the display.
    if (!image.has_alpha) image.rgb[i] = mix(background_at(sky), image.rgb[i], coverage);
    image.radiance[i] = mix(sky, image.radiance[i], coverage);
  });
  return image;
}

}  // namespace voxdag
