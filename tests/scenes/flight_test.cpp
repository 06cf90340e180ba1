/// Tests the flights of scene_preset(): they are valid camera paths, and the camera stays away from
/// the scene.
#include <gtest/gtest.h>

#include <cmath>

#include "voxdag/dag/build_svdag.hpp"
#include "voxdag/film/camera_path.hpp"
#include "voxdag/scenes/scenes.hpp"
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/svdag_nodes.hpp"
#include "voxdag/voxelize/grid_mapping.hpp"

namespace voxdag {
namespace {

struct Flight {
  const char* scene;
  double size;
  double clearance;  ///< Least distance of the camera from the scene, world units.
};

void PrintTo(const Flight& flight, std::ostream* out) { *out << flight.scene << flight.size; }

/// Returns the distance from `eye` to the nearest surface in many directions.
double nearest(const SvdagNodes& nodes, const Grid& grid, Vec3d eye) {
  constexpr int kDirections = 600;
  double least = HUGE_VAL;
  for (int i = 0; i < kDirections; ++i) {  // a spiral around the sphere
    const double z = 1 - (2 * i + 1.0) / kDirections, turn = i * 2.399963229728653;
    const double r = std::sqrt(1 - z * z);
    const Vec3d direction{r * std::cos(turn), r * std::sin(turn), z};
    const GridRay ray = make_grid_ray(grid, eye, direction, 0, HUGE_VAL);
    CellHit cell;
    if (cast(nodes, ray, StopAtVoxels{}, cell))
      least = std::min(least, ray.to_world_t(static_cast<double>(cell.t)));
  }
  return least;
}

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

  const Mesh mesh = make_scene(GetParam().scene, options);
  const Grid grid = fit_grid(mesh, 9);
  const Svdag dag = build_svdag(mesh, grid).dag;
  const SvdagNodes nodes(dag.view());
  for (double time = 0; time <= path.end(); time += 0.1) {
    const View view = path.at(time);
    EXPECT_GE(nearest(nodes, grid, view.eye), GetParam().clearance)
        << "at " << time << " s: " << view.eye.x << "," << view.eye.y << "," << view.eye.z;
    const Vec3d ahead = view.target - view.eye;
    EXPECT_GT(dot(ahead, ahead), 1e-3 * dot(preset.eye - preset.target, preset.eye - preset.target))
        << time;
  }
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
