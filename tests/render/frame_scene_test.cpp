#include <gtest/gtest.h>

#include <limits>

#include "support/brute_svdag.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/render/camera.hpp"
#include "voxdag/render/view.hpp"

namespace voxdag {
namespace {

Grid grid_of(int levels) {
  Grid grid;
  grid.levels = levels;
  grid.origin = {100, -20, 3};
  grid.voxel_size = 0.25;
  return grid;
}

bool is_in_picture(const View& view, double aspect, Vec3d point) {
  const Camera camera = make_camera(view, 1000, static_cast<int>(1000 / aspect));
  const Vec3d d = point - camera.eye;
  const double depth = dot(d, camera.forward);
  const double x = dot(d, camera.right) / dot(camera.right, camera.right) / depth;
  const double y = dot(d, camera.up) / dot(camera.up, camera.up) / depth;
  return depth > 0 && std::fabs(x) <= 1 && std::fabs(y) <= 1;
}

TEST(FrameScene, ShowsEveryVoxelOfAnObject) {
  const int levels = 6;
  const Grid grid = grid_of(levels);
  for (const double aspect : {0.4, 1.0, 1.78, 4.0}) {
    std::vector<Vec3i> voxels;  // two rods that cross: nothing is hidden
    for (std::int32_t i = 0; i < 60; ++i) {
      voxels.push_back({i, 20, 30});
      voxels.push_back({11, i, 31});
    }
    const Svdag dag = brute_svdag(levels, voxels);
    const View view = frame_scene(dag.view(), grid, aspect, {});
    for (const Vec3i v : voxels)
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3i p = v + child_offset(corner);
        EXPECT_TRUE(is_in_picture(view, aspect, grid.to_world(static_cast<Vec3d>(p))));
      }
  }
}

TEST(FrameScene, TakesZAsUpIfTheSceneLiesOnIt) {
  std::vector<Vec3i> voxels;
  for (std::int32_t y = 0; y < 64; ++y)
    for (std::int32_t x = 0; x < 64; ++x) voxels.push_back({x, y, 5});
  const Svdag dag = brute_svdag(6, voxels);
  EXPECT_EQ(frame_scene(dag.view(), grid_of(6), 1.5, {}).up, (Vec3d{0, 0, 1}));
  for (Vec3i& v : voxels) v = {v.x, v.z, v.y};
  const Svdag flat = brute_svdag(6, voxels);
  EXPECT_EQ(frame_scene(flat.view(), grid_of(6), 1.5, {}).up, (Vec3d{0, 1, 0}));
}

/// Returns a closed box of 64³ voxels with pillars and shelves.
Svdag room() {
  std::vector<Vec3i> voxels;
  for (std::int32_t z = 0; z < 64; ++z)
    for (std::int32_t y = 0; y < 64; ++y)
      for (std::int32_t x = 0; x < 64; ++x) {
        const bool is_wall = std::min({x, y, z}) == 0 || std::max({x, y, z}) == 63;
        const bool is_pillar = (x / 4 == 4 || x / 4 == 11) && (z / 4 == 4 || z / 4 == 11);
        const bool is_shelf = y % 6 == 0 && (z < 9 || z > 54 || x < 9 || x > 54);
        if (is_wall || is_pillar || is_shelf) voxels.push_back({x, y, z});
      }
  return brute_svdag(6, voxels);
}

TEST(FrameScene, LooksFromInsideIfTheSceneIsARoom) {
  const Svdag dag = room();
  const Grid grid = grid_of(6);
  const View view = frame_scene(dag.view(), grid, 1.5, {});
  const Vec3d eye = grid.to_grid(view.eye);
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_GT(eye[axis], 1);
    EXPECT_LT(eye[axis], 63);
  }
}

TEST(HomeView, IsRoundedAndShowsARoomFromInsideAgain) {
  const Svdag dag = room();
  const Grid grid = grid_of(6);
  const HomeView home = home_view(dag.view(), grid, {});
  ASSERT_TRUE(home.sun);
  for (const Vec3d point : {home.eye, home.target})
    for (int axis = 0; axis < 3; ++axis) {
      const double steps = (point[axis] - grid.origin[axis]) / grid.side() * 1024;
      EXPECT_EQ(steps, std::round(steps));
    }
  ViewRequest request;
  request.home = home;
  request.scene_up = home.up;
  EXPECT_EQ(frame_scene(dag.view(), grid, 0.7, request), static_cast<const View&>(home));
  EXPECT_TRUE(shows_interior(dag.view(), grid, request, home));
}

TEST(HomeView, FromOutsideGivesTheDirectionForEveryShapeOfPicture) {
  const Svdag dag = brute_svdag(6, {{10, 20, 30}, {50, 20, 33}, {30, 40, 8}});
  const Grid grid = grid_of(6);
  ViewRequest request;
  request.scene_up = Vec3d{0, 0, 1};
  request.home = home_view(dag.view(), grid, request.scene_up);
  EXPECT_EQ(request.home->up, (Vec3d{0, 0, 1}));
  const Vec3d forward = normalized(request.home->target - request.home->eye);
  EXPECT_LT(forward.z, -0.3);  // From above.
  for (const double aspect : {0.5, 1.0, 3.0}) {
    const View view = frame_scene(dag.view(), grid, aspect, request);
    EXPECT_GT(dot(normalized(view.target - view.eye), forward), 1 - 1e-9);
    EXPECT_TRUE(is_in_picture(view, aspect, grid.to_world({10, 20, 30})));
    EXPECT_TRUE(is_in_picture(view, aspect, grid.to_world({51, 21, 34})));
  }
}

TEST(HomeView, TheUpAxisOfTheSceneWinsOverItsShapeAndARequestOverBoth) {
  const Svdag dag = room();
  ViewRequest request;
  request.scene_up = Vec3d{1, 0, 0};
  EXPECT_EQ(frame_scene(dag.view(), grid_of(6), 1, request).up, (Vec3d{1, 0, 0}));
  request.up = Vec3d{0, 0, 1};
  EXPECT_EQ(frame_scene(dag.view(), grid_of(6), 1, request).up, (Vec3d{0, 0, 1}));
}

TEST(SceneViews, AreInsideARoomAndDiffer) {
  const Svdag dag = room();
  const Grid grid = grid_of(6);
  const std::vector<View> views = scene_views(dag.view(), grid, 1.5, 3);
  ASSERT_EQ(views.size(), 3u);
  EXPECT_EQ(views[0].eye, frame_scene(dag.view(), grid, 1.5, {}).eye);
  for (const View& view : views)
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_GT(grid.to_grid(view.eye)[axis], 1);
      EXPECT_LT(grid.to_grid(view.eye)[axis], 63);
    }
  EXPECT_NE(views[0].eye, views[1].eye);
  EXPECT_NE(views[1].eye, views[2].eye);
}

TEST(SceneViews, AreAroundAnObject) {
  std::vector<Vec3i> voxels;
  for (std::int32_t i = 10; i < 50; ++i) voxels.push_back({i, i, i});
  const Svdag dag = brute_svdag(6, voxels);
  const std::vector<View> views = scene_views(dag.view(), grid_of(6), 1.5, 4);
  ASSERT_EQ(views.size(), 4u);
  for (const View& view : views)
    for (const Vec3i v : voxels)
      EXPECT_TRUE(is_in_picture(view, 1.5, grid_of(6).to_world(static_cast<Vec3d>(v))));
}

TEST(SceneViews, AnEmptySceneHasViews) {
  for (const View& view : scene_views(Svdag{}.view(), Grid{}, 1, 3))
    EXPECT_NE(view.eye, view.target);
}

TEST(FrameScene, KeepsTheRequestedValues) {
  const Svdag dag = room();
  const Grid grid = grid_of(6);
  ViewRequest request;
  request.eye = {1, 2, 3};
  request.target = {4, 5, 7};
  request.up = {0, 0, 1};
  request.vertical_fov_degrees = 12;
  const View view = frame_scene(dag.view(), grid, 1.5, request);
  EXPECT_EQ(view.eye, *request.eye);
  EXPECT_EQ(view.target, *request.target);
  EXPECT_EQ(view.up, *request.up);
  EXPECT_EQ(view.vertical_fov_degrees, 12);

  ViewRequest eye_only;
  eye_only.eye = {1, 2, 3};
  EXPECT_EQ(frame_scene(dag.view(), grid, 1.5, eye_only).target, grid.to_world({32, 32, 32}));
  ViewRequest target_only;
  target_only.target = {100, 0, 0};
  EXPECT_EQ(frame_scene(dag.view(), grid, 1.5, target_only).target, *target_only.target);
}

TEST(FrameScene, AViewStraightDownOrUpFindsItsOwnUp) {
  for (const double y : {-1.0, 1.0}) {
    ViewRequest request;
    request.eye = {32, 32, 32};
    request.target = {32, 32 + y, 32};
    EXPECT_EQ(frame_scene(brute_svdag(6, {{1, 2, 3}}).view(), grid_of(6), 1.5, request).up,
              (Vec3d{0, 0, -1}));
  }
  EXPECT_EQ(up_across({0, 0, 1}, {0, 0, -5}), (Vec3d{0, 1, 0}));
  EXPECT_EQ(up_across({0, 0, 1}, {0, 1, -5}), (Vec3d{0, 0, 1}));
}

TEST(FrameScene, AnEmptySceneHasAView) {
  const View view = frame_scene(Svdag{}.view(), Grid{}, 1, {});
  EXPECT_TRUE(std::isfinite(view.eye.x) && std::isfinite(view.target.x));
}

TEST(FrameScene, RefusesRequestsThatDefineNoView) {
  const Svdag dag = brute_svdag(3, {{1, 2, 3}});
  const auto frame = [&](auto&& change) {
    ViewRequest request;
    change(request);
    return frame_scene(dag.view(), grid_of(3), 1, request);
  };
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(frame([](auto& r) { r.eye = {kNan, 0, 0}; }), Error);
  EXPECT_THROW(frame([](auto& r) { r.up = {0, 0, 0}; }), Error);
  EXPECT_THROW(frame([](auto& r) { r.vertical_fov_degrees = 0; }), Error);
  EXPECT_THROW(frame([](auto& r) { r.vertical_fov_degrees = 180; }), Error);
  EXPECT_THROW(frame([](auto& r) { r.eye = r.target = {1, 1, 1}; }), Error);
  EXPECT_THROW(frame([](auto& r) {
                 r.eye = {0, 0, 0};
                 r.target = {0, 2, 0};
                 r.up = {0, -1, 0};
               }),
               Error);
}

}  // namespace
}  // namespace voxdag
