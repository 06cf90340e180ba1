#pragma once
/// Procedural scenes: seeded, and the same bytes on every machine (only +, -, *, / and square roots
/// of IEEE doubles are used; sines come from a polynomial of our own).
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "voxdag/core/vec.hpp"
#include "voxdag/mesh/mesh.hpp"
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

struct SceneOptions {
  double size = 0;         ///< What it counts is said by SceneInfo; 0 takes the default.
  std::uint32_t seed = 1;  ///< Of the random numbers, if SceneInfo::uses_seed.
};

struct SceneInfo {
  std::string_view name;
  std::string_view description;   ///< One line.
  std::string_view size_meaning;  ///< What SceneOptions::size counts.
  double default_size, min_size, max_size;
  bool uses_seed = true;  ///< Whether SceneOptions::seed changes the scene.
};

/// Where a flight is at a time.
struct SceneKey {
  double time = 0;  ///< Seconds, from 0 on, rising.
  Vec3d eye, target;
};

/// A camera and a sun that show a scene well, in the mesh's world units.
struct ScenePreset {
  Vec3d eye, target;
  Vec3d up{0, 1, 0};
  double fov_degrees = 60;       ///< Vertical angle of view, for pictures of 16:9.
  Vec3d sun_direction;           ///< Unit vector from the scene towards the sun.
  std::vector<SceneKey> flight;  ///< A film, with the same up and angle of view.
};

/// Every scene, in alphabetical order.
std::span<const SceneInfo> scene_list();

/// World units are metres, y is up, right-handed; triangles wind counter-clockwise seen from
/// outside. Materials name the parts. Throws Error for an unknown name or a size outside the
/// scene's range, Cancelled when `progress` (may be null) is asked to stop.
Mesh make_scene(std::string_view name, const SceneOptions& options = {},
                const Progress* progress = nullptr);

/// The view for the scene that make_scene gives for the same arguments. Throws as make_scene.
ScenePreset scene_preset(std::string_view name, const SceneOptions& options = {});

}  // namespace voxdag
