#pragma once
/// `voxdag build --bake-ao`: ambient occlusion in the colours of an ESVO.
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "cli/command.hpp"
#include "voxdag/builders/esvo/build/build_esvo.hpp"
#include "voxdag/cpu/surface_openness.hpp"

namespace voxdag::cli {

struct BakeArguments {
  int rays = 0;               ///< Rays per point; 0: nothing is baked.
  double distance = 0;        ///< Length of the rays, world units; 0: kDefaultDistance grid sides.
  std::optional<int> levels;  ///< Of the octree that hides the sky; empty: those of the ESVO.
  static constexpr double kDefaultDistance = 0.15;  ///< The default of `render --ao`, too.

  double distance_in(const Grid& grid) const {
    if (distance > 0) return distance;
    return kDefaultDistance * grid.side();
  }
  int levels_in(const Grid& grid) const { return levels.value_or(grid.levels); }

  /// Throws UsageError if the octree that hides the sky is to be finer than an ESVO of so many
  /// levels.
  void check_levels(int esvo_levels) const;
};

/// Adds --bake-ao, --ao-distance and --ao-resolution to a group of options.
void add_bake_options(const Command& command, BakeArguments& arguments,
                      const std::function<bool()>& has_colors, const std::string& group);

/// Adds the arguments to the settings for the metadata.
void add_bake_settings(const BakeArguments& arguments, const Grid& grid,
                       std::map<std::string, std::string>& settings);

/// The voxels that hide the sky from points of a surface: an ESVO of that surface, with alpha masks
/// and displacement, without colours.
class Occluders {
 public:
  /// Builds the octree, and counts its memory as long as it lives. Throws like build_esvo().
  Occluders(const Mesh& mesh, const Grid& grid, const BakeArguments& arguments,
            const EsvoOptions& options, const SurfaceShading& shading,
            const DisplacedTriangles* displaced, Work work);
  Occluders(const Occluders&) = delete;
  Occluders& operator=(const Occluders&) = delete;

  /// Returns the light to bake, for EsvoSettings; valid while this object lives. The light throws
  /// Cancelled.
  SurfaceLight light() const;

 private:
  Grid grid_;
  Work work_;
  MemoryReservation memory_;
  Esvo esvo_;
  std::optional<SurfaceOpenness> openness_;
};

}  // namespace voxdag::cli
