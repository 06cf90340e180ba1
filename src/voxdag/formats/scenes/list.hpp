#pragma once
/// The generators behind make_scene(), one file each. `size` must be in the range of the scene's
/// SceneInfo. They throw Cancelled.
#include <cstdint>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/formats/scenes/scenes.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag::scenes {

Mesh make_city(double size, std::uint32_t seed, Work work);
ScenePreset city_preset(double size);

Mesh make_courtyard(double size, std::uint32_t seed, Work work);
ScenePreset courtyard_preset(double size);

Mesh make_hairball(double size, std::uint32_t seed, Work work);
ScenePreset hairball_preset(double size);

Mesh make_sponge(double size, std::uint32_t seed, Work work);
ScenePreset sponge_preset(double size);

Mesh make_terrain(double size, std::uint32_t seed, Work work);
ScenePreset terrain_preset(double size);

}  // namespace voxdag::scenes
