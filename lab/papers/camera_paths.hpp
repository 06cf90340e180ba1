#pragma once
/// Camera paths through real scenes of the papers, for benchmarks that repeat fly-throughs.
#include <cstdint>
#include <span>
#include <string_view>

#include "voxdag/formats/scenes/scenes.hpp"
#include "voxdag/render/film/path_file.hpp"

namespace voxdag::lab {

/// A flight through the mesh of one file. Positions and lengths are in the mesh's world units.
struct SceneFlight {
  std::string_view name;
  std::string_view file;     ///< The name of the mesh's file.
  std::uint64_t file_check;  ///< XXH3-64 of the mesh's file.
  double clearance;          ///< Least distance of the camera from any surface, at 512³ voxels.
  Vec3d up;                  ///< Unit vector.
  double fov_degrees;        ///< Vertical field of view, for pictures of 16:9.
  Vec3d sun_direction;       ///< Direction towards the sun; its length has no meaning.
  std::span<const SceneKey> keys;
};

/// Returns all flights, in alphabetical order.
std::span<const SceneFlight> scene_flights();

/// Returns the flight through the mesh file with this XXH3-64, or null.
const SceneFlight* flight_of(std::uint64_t file_check);

/// Returns the flight, and its first key as the view that shows the scene.
ScenePreset preset_of(const SceneFlight& flight);

/// Returns the preset's flight in the form that path_json() prints and `render --path` reads.
PathFile path_file(const ScenePreset& preset);

}  // namespace voxdag::lab
