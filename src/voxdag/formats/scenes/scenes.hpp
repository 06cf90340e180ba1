#pragma once
/// Procedural scenes. A scene has the same bytes on every machine: the generators use only +, -, *,
/// / and square roots of IEEE doubles, and compute sines by a polynomial.
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/core/vec.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

struct SceneOptions {
  double size = 0;         ///< In units of SceneInfo::size_meaning; 0: default.
  std::uint32_t seed = 1;  ///< Seed of the random numbers, if SceneInfo::uses_seed.
};

struct SceneInfo {
  std::string_view name;
  std::string_view description;   ///< One line.
  std::string_view size_meaning;  ///< The thing that SceneOptions::size counts.
  double default_size, min_size, max_size;
  bool uses_seed = true;  ///< Whether SceneOptions::seed changes the scene.
};

/// The camera of a flight at one time.
struct SceneKey {
  double time = 0;  ///< Seconds, from 0, increasing.
  Vec3d eye, target;
};

/// A camera and a sun that show a scene well, in the mesh's world units.
struct ScenePreset {
  Vec3d eye, target;
  Vec3d up{0, 1, 0};
  double fov_degrees = 60;       ///< Vertical field of view, for pictures of 16:9.
  Vec3d sun_direction;           ///< Unit vector from the scene towards the sun.
  std::vector<SceneKey> flight;  ///< A camera path with this up and field of view.
};

/// Returns all scenes, in alphabetical order.
std::span<const SceneInfo> scene_list();

/// Generates a scene. World units are metres, y is up, axes are right-handed, triangles wind
/// counter-clockwise seen from outside. Materials name the parts. Throws Error for an unknown name
/// or a size outside the scene's range, and Cancelled if `work` is cancelled.
Mesh make_scene(std::string_view name, const SceneOptions& options = {}, Work work = {});

/// Returns a good view of the scene that make_scene() generates from these arguments. Throws Error
/// for an unknown name or a size outside the scene's range.
ScenePreset scene_preset(std::string_view name, const SceneOptions& options = {});

}  // namespace voxdag
