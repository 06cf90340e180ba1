#pragma once
/// `voxdag build --bake-ao`: ambient occlusion in the colours of an ESVO.
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "cli/command.hpp"
#include "voxdag/cpu/surface_openness.hpp"
#include "voxdag/esvo/build/build_esvo.hpp"

namespace voxdag {

struct BakeArguments {
  int rays = 0;         ///< Per point; 0: none, nothing is baked.
  double distance = 0;  ///< Length of the rays, world units; 0: kDefaultDistance grid sides.
  static constexpr double kDefaultDistance = 0.15;  ///< As for `render --ao`.

  double distance_in(const Grid& grid) const {
    if (distance > 0) return distance;
    return kDefaultDistance * grid.side();
  }
};

/// Adds --bake-ao and --ao-distance to the group of options.
void add_bake_options(const Command& command, BakeArguments& arguments,
                      const std::function<bool()>& has_colors, const std::string& group);

/// Adds the arguments to the settings for the metadata.
void add_bake_settings(const BakeArguments& arguments, const Grid& grid,
                       std::map<std::string, std::string>& settings);

/// Hides the sky from points of a surface: an ESVO of the same surface, with cut-outs and
/// displacement, without colours and no finer than 1024³.
class Occluders {
 public:
  Occluders(const Mesh& mesh, const Grid& grid, const BakeArguments& arguments,
            const EsvoOptions& build, const SurfaceShading& shading,
            const DisplacedTriangles* displaced, Progress& progress);
  Occluders(const Occluders&) = delete;
  Occluders& operator=(const Occluders&) = delete;

  /// Returns the light for EsvoSettings of an ESVO in the grid; valid while this object lives.
  SurfaceLight light() const;

 private:
  Grid grid_;
  MemoryReservation memory_;
  Esvo esvo_;
  std::optional<SurfaceOpenness> openness_;
};

}  // namespace voxdag
