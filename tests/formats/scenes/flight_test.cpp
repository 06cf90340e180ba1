/// Tests the flights of scene_preset(): they are valid camera paths, and the camera stays away from
/// the scene.
#include <gtest/gtest.h>

#include <cmath>

#include "support/clearance.hpp"
#include "voxdag/formats/scenes/scenes.hpp"

namespace voxdag {
namespace {

struct Flight {
  const char* scene;
  double size;
  double clearance;  ///< Least distance of the camera from the scene, world units.
};

void PrintTo(const Flight& flight, std::ostream* out) { *out << flight.scene << flight.size; }

class Flights : public testing::TestWithParam<Flight> {};

TEST_P(Flights, KeepClearOfTheScene) {
  const SceneOptions options{GetParam().size, 1};
  const ScenePreset preset = scene_preset(GetParam().scene, options);
  std::vector<CameraKey> keys;
  for (const SceneKey& key : preset.flight)
    keys.push_back({key.time, {key.eye, key.target, preset.up, preset.fov_degrees}});
  const CameraPath path(keys);
  EXPECT_EQ(path.start(), 0);
  EXPECT_GE(keys.size(), 8u);

  const Vec3d ahead = preset.eye - preset.target;
  expect_clear_path(path, make_scene(GetParam().scene, options), GetParam().clearance,
                    std::sqrt(1e-3 * dot(ahead, ahead)));
}

INSTANTIATE_TEST_SUITE_P(All, Flights,
                         testing::Values(Flight{"city", 1, 2}, Flight{"city", 2, 2},
                                         Flight{"city", 3, 2}, Flight{"city", 6, 2},
                                         Flight{"courtyard", 0.4, 0.3}, Flight{"hairball", 20, 0.5},
                                         Flight{"sponge", 3, 0.08}, Flight{"terrain", 128, 25}),
                         [](const auto& flight) {
                           return std::string(flight.param.scene) +
                                  std::to_string(static_cast<int>(flight.param.size));
                         });

}  // namespace
}  // namespace voxdag
