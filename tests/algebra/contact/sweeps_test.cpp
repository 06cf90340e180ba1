// Sweeps against loops over all voxels, with other formulas.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "algebra/contact/contact_world.hpp"
#include "algebra/voxel_grid.hpp"
#include "support/voxel_sets.hpp"

namespace voxdag {
namespace {

TEST(Sweeps, ASweepEndsAtTheFirstVoxelThatItMeets) {
  int hits = 0, skipped = 0;
  for (const NamedVoxels& set : voxel_sets(4, 8)) {
    if (set.voxels.size() > 300) continue;
    SCOPED_TRACE(set.name);
    const World world(4, set.voxels);
    Shapes shapes(4, 2);
    for (int i = 0; i < 40; ++i) {
      Capsule shape = shapes.capsule();
      shape.radius = std::max(shape.radius, 0.01);  // A gap that falls below 0 can be bisected.
      const Vec3d motion = shapes.vector(16);
      double first = kNever;
      bool is_sure = true;
      for (const Vec3i voxel : set.voxels) {
        const double t = touch_time(voxel, shape, motion);
        is_sure = is_sure && !std::isnan(t);
        if (t < first) first = t;
      }
      if (!is_sure) {
        ++skipped;
        continue;
      }
      const SweepHit hit = sweep(world.scene, world.shape(shape), motion * world.size(1));
      ASSERT_EQ(hit.hit, first != kNever) << i;
      if (!hit.hit) continue;
      ++hits;
      ASSERT_NEAR(hit.t, first, 1e-7) << i;
      const Capsule there = moved(shape, motion * hit.t);
      const double core_gap = segment_gap(hit.voxel, there.from, there.to);
      EXPECT_LE(core_gap, shape.radius + 2 * kTouch);
      EXPECT_NEAR(point_gap(hit.voxel, world.scene.grid.to_grid(hit.point)), 0, kClose);
      if (hit.t > 0) {
        EXPECT_GE(core_gap, shape.radius - kClose);
        EXPECT_NEAR(length(hit.normal), 1, kClose);
        EXPECT_LT(dot(hit.normal, motion), 0);
      }
    }
  }
  EXPECT_GT(hits, 40);
  EXPECT_LT(skipped, hits / 10);
}

TEST(Sweeps, SweepsAgainstFacesEdgesAndCornersAreThoseOfGeometry) {
  const World world(4, {{8, 8, 8}});
  const auto sweep_of = [&](Vec3d from, double radius, Vec3d motion) {
    return sweep(world.scene, world.shape(Capsule::sphere(from, radius)), motion * world.size(1));
  };
  const SweepHit face = sweep_of({8.5, 8.25, 14}, 2, {0, 0, -10});
  ASSERT_TRUE(face.hit);
  EXPECT_NEAR(face.t, 0.3, kClose);  // From 14 to 9 + 2.
  EXPECT_EQ(face.normal, (Vec3d{0, 0, 1}));
  EXPECT_EQ(world.scene.grid.to_grid(face.point), (Vec3d{8.5, 8.25, 9}));
  // The sphere passes the edge x = 9, z = 9 at a distance of 1.2 to the right.
  const SweepHit edge = sweep_of({10.2, 8.5, 19}, 2, {0, 0, -10});
  EXPECT_NEAR(edge.t, (10 - 1.6) / 10, kClose);
  EXPECT_NEAR(edge.normal.x, 0.6, kClose);
  EXPECT_NEAR(edge.normal.z, 0.8, kClose);
  const SweepHit corner = sweep_of({19, 19, 19}, std::sqrt(3.0), {-10, -10, -10});
  EXPECT_NEAR(corner.t, 0.9, kClose);
  EXPECT_NEAR(corner.normal.y, std::sqrt(1 / 3.0), kClose);
  EXPECT_NEAR(length(world.scene.grid.to_grid(corner.point) - Vec3d{9, 9, 9}), 0, kClose);
  // A point, which needs its direction before it is there.
  const SweepHit point = sweep_of({19, 8.5, 12}, 0, {-20, 0, -7});
  EXPECT_NEAR(point.t, 0.5, kClose);
  EXPECT_EQ(point.normal, (Vec3d{1, 0, 0}));
  // Passing at a distance, ending before, and moving away.
  EXPECT_FALSE(sweep_of({11.01, 8.5, 19}, 2, {0, 0, -30}).hit);
  EXPECT_FALSE(sweep_of({8.5, 8.5, 19}, 2, {0, 0, -7.99}).hit);
  EXPECT_TRUE(sweep_of({8.5, 8.5, 19}, 2, {0, 0, -8}).hit);
  EXPECT_FALSE(sweep_of({8.5, 8.5, 12}, 2, {0, 0, 5}).hit);
}

TEST(Sweeps, AShapeThatTouchesAtTheStartMayLeaveAndSlideButNotApproach) {
  const World world(3, voxels_where(3, [](Vec3i v) { return v.z < 2; }));
  for (const double radius : {0.5, 1.75})
    for (const double depth : {0.0, 0.25}) {
      const Capsule ball = world.shape(Capsule::sphere({4.3, 4.6, 2 + radius - depth}, radius));
      const auto moves = [&](Vec3d motion) { return sweep(world.scene, ball, motion); };
      EXPECT_TRUE(overlaps(world.scene, ball));
      EXPECT_FALSE(moves({0, 0, 1}).hit);
      EXPECT_FALSE(moves({0, 0, 0}).hit);
      ASSERT_TRUE(moves({0, 0, -1}).hit);
      EXPECT_EQ(moves({0, 0, -1}).t, 0);
      EXPECT_EQ(moves({0, 0, -1}).normal, (Vec3d{0, 0, 1}));
      EXPECT_EQ(moves({0.4, 0.3, 0.001}).hit, depth > 0);  // Edges of the next voxels stop it.
    }
  // A core that touches cannot tell where out is.
  const SweepHit inside = sweep(world.scene, world.shape(Capsule::sphere({4, 4, 1}, 1)), {0, 0, 9});
  EXPECT_TRUE(inside.hit);
  EXPECT_EQ(inside.t, 0);
  EXPECT_EQ(inside.normal, (Vec3d{}));
}

TEST(Sweeps, LongMotionsEndAtTheVoxel) {
  const World world(4, {{8, 8, 8}});
  const Vec3d far = world.place({8.5, 8.5, 1e9 + 8.5});
  const SweepHit hit = sweep(world.scene, Capsule::sphere(far, world.size(2)), {0, 0, -1e9});
  ASSERT_TRUE(hit.hit);
  EXPECT_NEAR(hit.t * 1e9, far.z - world.place({0, 0, 11}).z, 1e-6);
}

}  // namespace
}  // namespace voxdag
