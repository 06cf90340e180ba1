#pragma once
/// The options of a picture, and the rendered picture.
#include <memory>
#include <optional>
#include <vector>

#include "voxdag/render/environment.hpp"
#include "voxdag/render/filter_kind.hpp"
#include "voxdag/render/light.hpp"
#include "voxdag/render/render_setup.hpp"
#include "voxdag/render/tone_map.hpp"
#include "voxdag/render/view.hpp"

namespace voxdag {

/// The longest occlusion ray by default, as a fraction of the grid's side; and that of an interior
/// (see shows_interior()), where light comes from far.
inline constexpr double kOcclusionDistance = 0.15, kInteriorOcclusion = 0.8;

/// The default direction towards the sun, as factors of the picture's right, up and back.
inline constexpr Vec3d kDefaultSun{-0.6, 0.9, 0.25};

/// The largest values that programs accept from users; the smallest are 0.
struct RenderLimits {
  static constexpr double kSunDegrees = 89;
  static constexpr double kSky = 1e6;
  static constexpr int kOcclusionSamples = 4096;
  static constexpr double kOcclusionCone = 6;  ///< Steradians.
  static constexpr int kBounces = 64;
  static constexpr double kLodPixels = 1000, kCubePixels = 1e6;
};

/// The part of a scene that a picture shows, in world units.
struct SectionOptions {
  std::optional<Box3d> box;
  /// Shows the side of the plane through `point` from which `normal` points away.
  struct Plane {
    Vec3d point, normal;  ///< The normal is not zero.
  };
  std::optional<Plane> plane;
  bool hatch = false;  ///< Draw lines on the surfaces where the section cuts voxels.
};

/// The background of a picture, where it shows no surface. Only the colours of the sky depend on
/// the light.
inline constexpr float kGreyBackground = 0.36f;  ///< Linear light of the display.
enum class Background { kSky, kGrey, kWhite, kBlack, kTransparent };

struct RenderOptions {
  int width = 1920, height = 1080;  ///< Pixels; at least 1 each.
  ViewRequest view;                 ///< frame_scene finds the parts that are not set.
  int samples_per_pixel = 1;        ///< At least 1.

  bool with_sun = true;
  std::optional<Vec3d> sun;   ///< Towards the sun; if not set, that of the interior, or over the
                              ///< viewer's left shoulder.
  double sun_degrees = 0.53;  ///< The sun's angular diameter; 0: hard shadows.
  std::vector<LightSpec> lights;  ///< Besides the sun; at most RenderSetup::kMaxLights - 1.
  bool shadows = true;
  int shadow_samples = 16;  ///< Shadow rays per pixel and light with soft edges.
  float sky = 1;            ///< Factor on the light of the sky, and on the sky in the picture.
  /// The light from all directions instead of the clear sky, and its sun instead of the default
  /// one; null: the clear sky. Without a sun of its own there is only one if `sun` is set.
  std::shared_ptr<const Environment> environment;
  double environment_degrees = 0;  ///< Turns the environment to the left around the up vector.

  int occlusion_samples = 64;  ///< Rays of ambient occlusion per pixel; 0: none.
  /// Length of occlusion rays, in world units; 0 means kOcclusionDistance or kInteriorOcclusion.
  double occlusion_distance = 0;
  /// Occlusion rays end at cells that subtend this solid angle, in steradians; 0 means cells of the
  /// size of the surface's cell. The paper uses 0.07.
  double occlusion_cone = 0;
  /// If set, the light of the sky and of surfaces arrives by tracing paths (path_light.hpp),
  /// reflected up to this many times (0 to 64), instead of by ambient occlusion: a reference.
  /// Needs occlusion_samples, the number of paths per pixel; each has no longest distance.
  std::optional<int> bounces;

  /// Rays see only this part. Surfaces where it cuts voxels have a colour of their own.
  SectionOptions section;

  float lod_pixels = 1;  ///< RenderSettings explains this field and the next two.
  float cube_pixels = 24;
  bool beams = true;
  Vec3f albedo{0.62f, 0.60f, 0.57f};
  Specular specular;  ///< Highlights of the sun and the lights on surfaces that do not mirror.
  /// Hits at a DAG get the colour and the normal that this view stores for their place: the DAG's
  /// own attributes, or a DAG or an ESVO of the same mesh in a grid with the same corner and side.
  /// Must be in the memory of the device that renders. Empty: hits have `albedo`.
  LookView look;
  /// Surfaces mirror as the channels `metallic` and `roughness` of the look say, if it has them and
  /// their kind is u8 (microfacet.hpp). Surfaces without them, or with 0 and 1, are diffuse.
  bool reflections = true;
  /// Smooths voxels larger than pixels (post_filter.hpp), but not a source's points.
  FilterKind filter = FilterKind::kNone;
  float exposure = 0;  ///< Factor before tone mapping; 0: chosen to suit the picture.
  ToneMap tone = ToneMap::kNeutral;
  Background background = Background::kSky;
  /// Shadows on a ground under the voxels of a DAG. Not in an interior or a section, and only if an
  /// axis is up.
  bool ground = false;

  bool with_normal = true;     ///< Fill RenderedImage::normal; the guided filter does, too.
  bool with_occlusion = true;  ///< Fill RenderedImage::occlusion; the guided filter does, too.
  bool with_shadow = true;     ///< Fill RenderedImage::shadow; the guided filter does, too.
  bool with_steps = false;     ///< Fill RenderedImage::steps.
  bool with_albedo = false;    ///< Fill RenderedImage::albedo.
  bool with_cells = false;     ///< Fill RenderedImage::cells.
  bool with_material = false;  ///< Fill RenderedImage::material and cells. Needs `materials`.
  ColoredDagView materials;    ///< The materials of the voxels, in the memory of the host.
  int tile_size = 32;          ///< Pixels, 1 to 32. Pictures do not depend on it.
};

/// Rows from top to bottom, pixels from left to right, width * height values each; none of those
/// that the options do not ask for.
struct RenderedImage {
  int width = 0, height = 0;
  View view;                     ///< The view that it shows.
  float exposure = 0;            ///< The factor that was applied.
  std::vector<Vec3f> rgb;        ///< Tone mapped, linear light in [0,1]: encode as sRGB to display.
  std::vector<float> coverage;   ///< The part of the pixel's samples that hit a surface, 0 to 1.
  bool has_alpha = false;        ///< The background is transparent: alpha is the coverage.
  std::vector<Vec3f> radiance;   ///< Linear, before exposure and tone mapping; filtered.
  std::vector<float> depth;      ///< World units along the view axis; +infinity where nothing is.
  std::vector<Vec3f> normal;     ///< World space, unit length; zero where nothing is.
  std::vector<float> occlusion;  ///< The part of the sky's light that arrives, 0 to 1.
  std::vector<float> shadow;     ///< The part of the lights' light that arrives, 0 to 1.
  std::vector<float> steps;      ///< Steps of primary rays and beams; empty unless with_steps.
  std::vector<Vec3f> albedo;     ///< Linear diffuse colour; zero where nothing is.
  std::vector<SeenCell> cells;   ///< Cells of voxels; level -1 where nothing is, or of a mesh.
  std::vector<float> material;   ///< Ids; -1 where nothing is, or without a material.
  std::vector<std::uint8_t> cell_pixels;  ///< See pack_cell_pixels(); empty without filter.
  std::uint64_t rays = 0;                 ///< Rays cast: primary, shadow, occlusion.
};

/// Returns the addresses of the image's values; null for values that it does not have.
inline ImageBuffers buffers_of(RenderedImage& image) {
  const auto values = [](auto& pixels) { return pixels.empty() ? nullptr : pixels.data(); };
  return {values(image.radiance),    values(image.depth),  values(image.normal),
          values(image.occlusion),   values(image.shadow), values(image.steps),
          values(image.cell_pixels), values(image.albedo), values(image.cells),
          values(image.coverage)};
}

}  // namespace voxdag
