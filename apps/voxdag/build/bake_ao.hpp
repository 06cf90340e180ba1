#pragma once
/// `build --as esvo --bake-ao`.
#include <CLI/CLI.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "voxdag/cpu/surface_openness.hpp"
#include "voxdag/esvo/build/build_esvo.hpp"

namespace voxdag {

struct BakeArguments {
  int rays = 0;  ///< Per point; 0: no light is baked.
  /// How far occlusion reaches, in world units; 0: kDefaultDistance grid sides.
  double distance = 0;
  static constexpr double kDefaultDistance = 0.15;  ///< As `render --ao`.

  double distance_in(const Grid& grid) const {
    if (distance > 0) return distance;
    return kDefaultDistance * grid.voxel_size * static_cast<double>(grid.resolution());
  }
};

void add_bake_options(CLI::App& command, BakeArguments& arguments);

/// Adds the settings of the baked light to those in the metadata.
void add_bake_settings(const BakeArguments& arguments, const Grid& grid,
                       std::map<std::string, std::string>& settings);

/// The surface that hides the sky from a mesh's points: an ESVO of the mesh, with alpha masks and
/// displacement, without colours and no finer than 1024³.
class Occluders {
 public:
  Occluders(const Mesh& mesh, const Grid& grid, const BakeArguments& arguments,
            const EsvoOptions& options, const SurfaceShading& shading,
            const DisplacedTriangles* displaced, Progress& progress);
  Occluders(const Occluders&) = delete;
  Occluders& operator=(const Occluders&) = delete;

  /// Returns the light for EsvoSettings of an ESVO in the grid; valid while this lives.
  SurfaceLight light() const;

 private:
  Grid grid_;
  MemoryReservation memory_;
  Esvo esvo_;
  std::optional<SurfaceOpenness> openness_;
};

}  // namespace voxdag
