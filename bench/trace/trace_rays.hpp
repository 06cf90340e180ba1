#pragma once
/// The rays that `voxdag bench trace` measures: those that the renderer casts, recorded.
#include <array>
#include <cstddef>
#include <memory>
#include <string_view>
#include <vector>

#include "voxdag/render/light.hpp"
#include "voxdag/render/render_options.hpp"
#include "voxdag/render/render_setup.hpp"
#include "voxdag/trace/scalar_caster.hpp"
#include "voxdag/trace/visit_nodes.hpp"

namespace voxdag {

enum class RayClass {
  kPrimary,       ///< The first cell along a pixel's ray.
  kPrimaryBeams,  ///< The same, started by beams, whose own casts count as time.
  kShadow,        ///< Whether the sun is seen, a point in the sky.
  kSoft,          ///< Whether points on a lamp are seen.
  kAo,            ///< Short rays all around.
};
inline constexpr std::array kRayClasses{RayClass::kPrimary, RayClass::kPrimaryBeams,
                                        RayClass::kShadow, RayClass::kSoft, RayClass::kAo};

/// As in the JSON: "primary_beams".
std::string_view name_of(RayClass rays);

/// Whether the first cell is wanted, or only whether there is one.
constexpr bool is_closest(RayClass rays) {
  return rays == RayClass::kPrimary || rays == RayClass::kPrimaryBeams;
}

struct RayOptions {
  int width = 1024, height = 768;
  int shadow_samples = 16, occlusion_samples = 64;
  float lod_pixels = 1;
  double occlusion_cone = 0;  ///< As RenderOptions::occlusion_cone.
  /// Of greater sets of any-hit rays a part is taken: whole 8×8 pixels, evenly spread over the
  /// picture.
  std::size_t most_rays = 500'000;
};

/// What a camera's picture casts, in the order of 4×4 pixels along a Morton curve, all rays of a
/// pixel together: 16 rays or 64 that follow each other suit packets. Rays that miss the grid are
/// left out.
struct RecordedRays {
  /// Primary rays with and without beams are in step; those that beams spare miss everything.
  std::array<std::vector<CastRay>, kRayClasses.size()> rays;

  const std::vector<CastRay>& of(RayClass c) const { return rays[static_cast<std::size_t>(c)]; }
};

/// Casts the beams of a whole picture on all threads.
class BeamPass {
 public:
  BeamPass(const VoxelSet& scene, const Grid& grid, const RenderOptions& options);
  ~BeamPass();
  BeamPass(const BeamPass&) = delete;
  BeamPass& operator=(const BeamPass&) = delete;

  /// May be called again.
  void run();
  /// What run() found: for RenderSetup::beam_starts.
  const float* starts() const;
  const RenderSetup& setup() const;  ///< Without them.

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The picture that a view's rays are of.
RenderOptions picture_options(const VoxelSet& scene, const Grid& grid, const View& view,
                              const RayOptions& options);

/// Of those that meet the grid, in the same order. Starts are RenderSetup::beam_starts: rays that
/// beams spare miss everything; null is without beams.
std::vector<CastRay> primary_rays(const RenderSetup& setup, const float* beam_starts);

/// `beams` is of a picture of picture_options(), and has run.
RecordedRays record_rays(const VoxelSet& scene, const BeamPass& beams, const RayOptions& options);

/// The views that are measured: inside views, or views around an object, and the one that `render`
/// would take.
std::vector<View> bench_views(const VoxelSet& scene, const Grid& grid, double aspect, int count);

/// A cast ray in world units: the same points at the same t.
struct WorldRay {
  Vec3d origin, direction;
  float t_min = 0, t_max = 0;
};

WorldRay to_world_ray(const Grid& grid, const GridRay& ray);

}  // namespace voxdag
