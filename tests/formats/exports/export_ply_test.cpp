#include <gtest/gtest.h>

#include <cmath>

#include "exported_ply.hpp"
#include "support/temp_dir.hpp"

namespace voxdag {
namespace {

TEST(ExportPly, PointsAreVoxelCentresInTheWorld) {
  const TempDir dir;
  const ExportedScene scene(6, 500);
  export_ply_points(dir / "v.ply", scene.view(), scene.grid);
  const ExportedPly ply(read_text(dir / "v.ply"));
  EXPECT_FALSE(ply.has_doubles);
  std::set<VoxelKey> found;
  for (const Vec3d p : ply.vertices) {
    const Vec3d voxel = (p - scene.grid.origin) * 4.0 - Vec3d{0.5, 0.5, 0.5};
    EXPECT_EQ(Vec3d(Vec3i(voxel)), voxel);
    found.insert({int(voxel.x), int(voxel.y), int(voxel.z)});
  }
  EXPECT_EQ(found, scene.set);
  EXPECT_EQ(ply.vertices.size(), scene.set.size());
  EXPECT_EQ(dir.count(), 1);
}

TEST(ExportPly, FarFromTheOriginCoordinatesAreDoubles) {
  const TempDir dir;
  ExportedScene scene(6, 100);
  scene.grid.origin.x = 4e6;
  export_ply_points(dir / "v.ply", scene.view(), scene.grid);
  const ExportedPly ply(read_text(dir / "v.ply"));
  EXPECT_TRUE(ply.has_doubles);
  EXPECT_EQ(ply.vertices.size(), scene.set.size());
  EXPECT_EQ(std::fmod(ply.vertices[0].x, 0.25), 0.125);
}

TEST(ExportPly, FacesHaveNoNeighbourAndPointOutwards) {
  const TempDir dir;
  for (const bool cropped : {false, true}) {
    const ExportedScene scene(4, 1500);
    const Vec3i lo = cropped ? Vec3i{1, 2, 3} : Vec3i{0, 0, 0};
    const Vec3i hi = cropped ? Vec3i{15, 10, 11} : Vec3i{16, 16, 16};
    export_ply_faces(dir / "v.ply", scene.view(), scene.grid, windowed(lo, hi));
    const ExportedPly ply(read_text(dir / "v.ply"));
    const auto has = [&](Vec3i v) {
      return max(v, lo) == v && max(v + Vec3i{1, 1, 1}, hi) == hi && scene.has(v.x, v.y, v.z);
    };
    std::map<std::pair<VoxelKey, VoxelKey>, int> expected;
    for (const auto& [x, y, z] : scene.set)
      for (int axis = 0; axis < 3; ++axis)
        for (const int side : {-1, 1}) {
          Vec3i step{};
          step[axis] = side;
          if (has({x, y, z}) && !has(Vec3i{x, y, z} + step))
            expected[{{x, y, z}, {step.x, step.y, step.z}}] = 1;
        }
    EXPECT_EQ(faces_of(ply, scene.grid), expected);
  }
}

TEST(ExportPly, ALoneVoxelHasEightSharedCorners) {
  const TempDir dir;
  const Svdag dag = brute_svdag(3, {{3, 4, 7}});
  Grid grid;
  grid.levels = 3;
  export_ply_faces(dir / "v.ply", dag.view(), grid);
  const ExportedPly ply(read_text(dir / "v.ply"));
  EXPECT_EQ(ply.vertices.size(), 8u);
  EXPECT_EQ(ply.faces.size(), 6u);
}

}  // namespace
}  // namespace voxdag
