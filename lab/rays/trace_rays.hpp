#pragma once
/// Records the rays that the renderer casts, for `voxdag bench trace`.
#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "voxdag/render/light.hpp"
#include "voxdag/render/render_options.hpp"
#include "voxdag/render/render_setup.hpp"
#include "voxdag/render/tile.hpp"
#include "voxdag/trace/scalar_caster.hpp"
#include "voxdag/trace/visit_nodes.hpp"

namespace voxdag::lab {

enum class RayClass {
  kPrimary,       ///< The first cell along a pixel's ray.
  kPrimaryBeams,  ///< Primary rays that start where beams end; the time of the beams counts.
  kShadow,        ///< Tests whether the sun, a point in the sky, is visible.
  kSoft,          ///< Tests whether points on a lamp are visible.
  kAo,            ///< Short rays in all directions.
};
inline constexpr std::array kRayClasses{RayClass::kPrimary, RayClass::kPrimaryBeams,
                                        RayClass::kShadow, RayClass::kSoft, RayClass::kAo};

/// Returns the name of a class in the JSON: "primary_beams".
std::string_view name_of(RayClass rays);

/// Returns whether rays of a class find the first cell (closest hit). Other classes find only
/// whether there is a cell (any hit).
constexpr bool is_closest(RayClass rays) {
  return rays == RayClass::kPrimary || rays == RayClass::kPrimaryBeams;
}

struct RayOptions {
  int width = 1024, height = 768;
  int shadow_samples = 16, occlusion_samples = 64;
  float lod_pixels = 1;
  int beam_pixels = kCoarseBeamPixels;  ///< The side of the beams on the CPU, in pixels: 4 or 8.
  double occlusion_cone = 0;            ///< As RenderOptions::occlusion_cone.
  /// The maximum size of a set of any-hit rays. Larger sets are sampled in squares of 8×8 pixels,
  /// spread evenly over the picture.
  std::size_t most_rays = 500'000;
  std::optional<Vec3d> sun;  ///< Towards the sun; if not set, as RenderOptions::sun chooses it.
};

/// The rays of a camera's picture, without those that miss the grid. Squares of 4×4 pixels follow a
/// Morton curve, and all rays of a pixel are consecutive, so that 16 or 64 consecutive rays form
/// good packets.
struct RecordedRays {
  /// The rays of each class. A primary ray has the same index with and without beams. A ray whose
  /// beam meets nothing is stored as a ray that misses everything.
  std::array<std::vector<CastRay>, kRayClasses.size()> rays;

  const std::vector<CastRay>& of(RayClass c) const { return rays[static_cast<std::size_t>(c)]; }
};

/// Casts the beams of a whole picture on all threads.
class BeamPass {
 public:
  /// `beam_pixels` is the side of a beam in pixels: 4 or 8.
  BeamPass(const VoxelSet& scene, const Grid& grid, const RenderOptions& options,
           int beam_pixels = kCoarseBeamPixels);
  ~BeamPass();
  BeamPass(const BeamPass&) = delete;
  BeamPass& operator=(const BeamPass&) = delete;

  /// Casts the beams. May be called repeatedly.
  void run();
  /// Returns the results of run(), for RenderSetup::beam_starts.
  const float* starts() const;
  const RenderSetup& setup() const;  ///< Its beam_starts is null.

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Returns the options of the picture whose rays are recorded.
RenderOptions picture_options(const VoxelSet& scene, const Grid& grid, const View& view,
                              const RayOptions& options);

/// Returns the primary rays that meet the grid, in the order of the pixels. `beam_starts` is
/// RenderSetup::beam_starts, or null for rays without beams. A ray whose beam meets nothing becomes
/// a ray that misses everything.
std::vector<CastRay> primary_rays(const RenderSetup& setup, const float* beam_starts);

/// Records the rays of a view. `beams` must be for picture_options() and have run.
RecordedRays record_rays(const VoxelSet& scene, const BeamPass& beams, const RayOptions& options);

/// Returns the measured views: views from inside, or views around an object, and the view that
/// `render` chooses.
std::vector<View> bench_views(const VoxelSet& scene, const Grid& grid, double aspect, int count);

/// A cast ray, converted to world units: the same points at the same t.
struct WorldRay {
  Vec3d origin, direction;
  float t_min = 0, t_max = 0;
};

WorldRay to_world_ray(const Grid& grid, const GridRay& ray);

}  // namespace voxdag::lab
