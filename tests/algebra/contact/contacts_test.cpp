// Contacts against loops over all voxels, with other formulas.
#include "voxdag/algebra/contact/contacts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>

#include "algebra/contact/contact_world.hpp"
#include "algebra/voxel_grid.hpp"
#include "support/error_of.hpp"
#include "support/voxel_sets.hpp"
#include "support/with_threads.hpp"
#include "voxdag/edit/editable_dag.hpp"

namespace voxdag {
namespace {

TEST(Contacts, TheClosestVoxelIsTheClosestOfAll) {
  for (const NamedVoxels& set : voxel_sets(4, 7)) {
    SCOPED_TRACE(set.name);
    const World world(4, set.voxels);
    Shapes shapes(4, 1);
    for (int i = 0; i < 40; ++i) {
      const Capsule shape = shapes.capsule();
      double least = kNever;
      for (const Vec3i voxel : set.voxels) least = std::min(least, gap(voxel, shape));
      const ClosestVoxel found = closest(world.scene, world.shape(shape));
      ASSERT_EQ(found.is_found, !set.voxels.empty());
      EXPECT_EQ(overlaps(world.scene, world.shape(shape)), least <= 0);
      if (!found.is_found) continue;
      ASSERT_NEAR(found.distance, world.size(least), kClose);
      EXPECT_NEAR(gap(found.voxel, shape), least, kClose);
      const Vec3d point = world.scene.grid.to_grid(found.point);
      EXPECT_NEAR(point_gap(found.voxel, point), 0, kClose);
      EXPECT_NEAR(segment_gap(found.voxel, shape.from, shape.to),
                  length(found.normal) == 0 ? 0 : least + shape.radius, kClose);
      if (least + shape.radius > kClose) {  // The normal leads from the voxel to the core.
        const Vec3d core = point + found.normal * (least + shape.radius);
        const Vec3d along = shape.to - shape.from;
        const double u =
            dot(along, along) == 0
                ? 0
                : std::clamp(dot(core - shape.from, along) / dot(along, along), 0., 1.);
        EXPECT_NEAR(length(core - shape.from - along * u), 0, 1e-7);
      }
      EXPECT_TRUE(closest(world.scene, world.shape(shape), world.size(least + 1e-6)).is_found);
      EXPECT_FALSE(closest(world.scene, world.shape(shape), world.size(least - 1e-6)).is_found);
    }
  }
}

/// Returns the distance between a box and the cube of a voxel: alternating projections go to it.
double box_gap(Vec3i voxel, const OrientedBox& box) {
  Vec3d p = box.centre;
  double gap = 0;
  for (int i = 0; i < 3000; ++i) {
    const Vec3d in_cube = nearest_in(voxel, p), from = in_cube - box.centre;
    p = box.centre;
    for (int axis = 0; axis < 3; ++axis)
      p = p +
          box.axes[axis] * std::clamp(dot(from, box.axes[axis]), -box.half[axis], box.half[axis]);
    const double now = length(p - in_cube);
    if (now == 0 || std::fabs(now - gap) < 1e-14) return now;
    gap = now;
  }
  return gap;
}

TEST(Contacts, ABoxOverlapsVoxelsThatAlternatingProjectionsReach) {
  Shapes shapes(4, 3);
  int inside = 0, outside = 0;
  for (const char* name : {"one voxel", "corners", "one in 1000", "one in 30"})
    for (const NamedVoxels& set : voxel_sets(4, 9)) {
      if (set.name != name) continue;
      const World world(4, set.voxels);
      for (int i = 0; i < 100; ++i) {
        OrientedBox box{shapes.point(), {}};
        box.half = {shapes.number(0, 4), shapes.number(0, 4), shapes.number(0, 1)};
        if (i % 4 != 0) {
          box.axes[0] = normalized(shapes.vector(1));
          box.axes[1] = normalized(cross(box.axes[0], shapes.vector(1)));
          box.axes[2] = cross(box.axes[0], box.axes[1]);
        }
        double least = kNever;
        for (const Vec3i voxel : set.voxels)
          if (point_gap(voxel, box.centre) <= length(box.half))
            least = std::min(least, box_gap(voxel, box));
        if (least > 1e-7 && least < 1e-3) continue;  // Projections are slow to tell.
        OrientedBox there = box;
        there.centre = world.place(box.centre);
        there.half = box.half * world.size(1);
        EXPECT_EQ(overlaps(world.scene, there), least <= 1e-7) << set.name << " " << i;
        ++(least <= 1e-7 ? inside : outside);
      }
    }
  EXPECT_GT(inside, 20);
  EXPECT_GT(outside, 50);
}

TEST(Contacts, BoxesThatTouchOverlap) {
  const World world(4, {{8, 8, 8}});
  const auto box_at = [&](Vec3d centre) {
    return OrientedBox{world.place(centre), Vec3d{1, 1, 1} * world.size(0.5)};
  };
  EXPECT_TRUE(overlaps(world.scene, box_at({9.5, 8.5, 8.5})));
  EXPECT_TRUE(overlaps(world.scene, box_at({9.5, 9.5, 9.5})));
  EXPECT_FALSE(overlaps(world.scene, box_at({9.5 + 1e-6, 8.5, 8.5})));
}

/// Returns the signed distance of a point by looking at all places of the grid and around it.
double brute_signed(const VoxelGrid& voxels, Vec3d p) {
  const Vec3i place{static_cast<std::int32_t>(std::floor(p.x)),
                    static_cast<std::int32_t>(std::floor(p.y)),
                    static_cast<std::int32_t>(std::floor(p.z))};
  const bool is_inside = voxels.contains(place);
  const std::int32_t side = 1 << voxels.levels();
  double least = kNever;
  for (std::int32_t z = -1; z <= side; ++z)
    for (std::int32_t y = -1; y <= side; ++y)
      for (std::int32_t x = -1; x <= side; ++x)
        if (voxels.contains({x, y, z}) != is_inside)
          least = std::min(least, point_gap({x, y, z}, p));
  return is_inside ? -least : least;
}

TEST(Contacts, SignedDistancesAreThoseOfAllPlaces) {
  for (const NamedVoxels& set : voxel_sets(4, 10)) {
    SCOPED_TRACE(set.name);
    const World world(4, set.voxels);
    const VoxelGrid voxels(4, set.voxels);
    Shapes shapes(4, 4);
    for (int i = 0; i < 60; ++i) {
      const Vec3d p = shapes.point();
      const double expected = brute_signed(voxels, p);
      const SignedDistance found = signed_distance(world.scene, world.place(p));
      if (set.voxels.empty()) {
        EXPECT_EQ(found.distance, kNever);
        EXPECT_EQ(found.gradient, (Vec3d{}));
        continue;
      }
      ASSERT_NEAR(found.distance, world.size(expected), kClose);
      EXPECT_NEAR(length(found.gradient), 1, kClose);
      // Along the gradient is the surface.
      const Vec3d there = p - found.gradient * expected;
      EXPECT_NEAR(brute_signed(voxels, there), 0, kClose);
      const double most = std::fabs(expected) * 0.9;
      const SignedDistance capped = signed_distance(world.scene, world.place(p), world.size(most));
      EXPECT_EQ(capped.distance, std::copysign(world.size(most), expected));
      EXPECT_EQ(capped.gradient, (Vec3d{}));
      // A limit that is not reached changes nothing.
      EXPECT_EQ(signed_distance(world.scene, world.place(p), world.size(most / 0.8)).distance,
                found.distance);
    }
  }
}

TEST(Contacts, OnTheSurfaceTheGradientLeadsToTheEmptyPlaces) {
  const World world(3, voxels_where(3, [](Vec3i v) { return v.z < 4 && v.x < 4; }));
  const auto gradient = [&](Vec3d p) {
    const SignedDistance found = signed_distance(world.scene, world.place(p));
    EXPECT_EQ(found.distance, 0);
    return found.gradient;
  };
  EXPECT_EQ(gradient({1.5, 2.5, 4}), (Vec3d{0, 0, 1}));
  EXPECT_EQ(gradient({2, 2, 4}), (Vec3d{0, 0, 1}));
  EXPECT_EQ(gradient({2, 2.5, 0}), (Vec3d{0, 0, -1}));
  EXPECT_EQ(gradient({4, 2.5, 1.5}), (Vec3d{1, 0, 0}));
  const Vec3d edge = gradient({4, 2.5, 4});
  EXPECT_NEAR(edge.x, std::sqrt(0.5), kClose);
  EXPECT_NEAR(edge.z, std::sqrt(0.5), kClose);
}

TEST(Contacts, AnEditedVersionAnswersWithoutACopy) {
  World world(5, voxels_where(5, [](Vec3i v) { return v.z < 16; }));
  EditableDag edited(world.dag.view());
  edited.remove(make_box(world.scene.grid, world.place({8, 8, 8}), world.place({24, 24, 32})));
  const EditSnapshot snapshot = edited.snapshot();
  const ContactScene scene{snapshot.view(), world.scene.grid};
  const Svdag copy = snapshot.svdag();
  const ContactScene same{copy.view(), world.scene.grid};
  Shapes shapes(5, 5);
  for (int i = 0; i < 200; ++i) {
    const Capsule shape = world.shape(shapes.capsule());
    const Vec3d motion = shapes.vector(world.size(20));
    EXPECT_EQ(sweep(scene, shape, motion).t, sweep(same, shape, motion).t);
    EXPECT_EQ(closest(scene, shape).distance, closest(same, shape).distance);
    EXPECT_EQ(signed_distance(scene, shape.from).distance,
              signed_distance(same, shape.from).distance);
  }
  EXPECT_EQ(signed_distance(scene, world.place({16, 16, 16})).distance, world.size(8));
}

TEST(Contacts, BatchesAreThoseOfSingleCallsOnAnyNumberOfThreads) {
  const World world(5, random_voxels(5, 300, 6));
  Shapes shapes(5, 6);
  std::vector<Capsule> capsules;
  std::vector<Vec3d> motions, points;
  std::vector<OrientedBox> boxes;
  for (int i = 0; i < 1000; ++i) {
    capsules.push_back(world.shape(shapes.capsule()));
    motions.push_back(shapes.vector(5));
    points.push_back(world.place(shapes.point()));
    boxes.push_back({points.back(), Vec3d{0.5, 0.25, 0.25}});
  }
  for (const std::size_t threads : {1, 3})
    with_threads(threads, [&] {
      const std::size_t count = capsules.size();
      const auto touched = std::make_unique<bool[]>(2 * count);
      std::vector<SweepHit> hits(count);
      std::vector<ClosestVoxel> near(count);
      std::vector<SignedDistance> distances(count);
      overlaps(world.scene, capsules, {touched.get(), count});
      overlaps(world.scene, boxes, {touched.get() + count, count});
      sweep(world.scene, capsules, motions, hits);
      closest(world.scene, capsules, 2, near);
      signed_distance(world.scene, points, 2, distances);
      for (std::size_t i = 0; i < count; ++i) {
        EXPECT_EQ(touched[i], overlaps(world.scene, capsules[i]));
        EXPECT_EQ(touched[count + i], overlaps(world.scene, boxes[i]));
        const SweepHit hit = sweep(world.scene, capsules[i], motions[i]);
        EXPECT_TRUE(hits[i].hit == hit.hit && hits[i].t == hit.t && hits[i].voxel == hit.voxel &&
                    hits[i].point == hit.point && hits[i].normal == hit.normal);
        const ClosestVoxel closest_one = closest(world.scene, capsules[i], 2);
        EXPECT_TRUE(near[i].distance == closest_one.distance &&
                    near[i].voxel == closest_one.voxel && near[i].normal == closest_one.normal);
        const SignedDistance distance = signed_distance(world.scene, points[i], 2);
        EXPECT_TRUE(distances[i].distance == distance.distance &&
                    distances[i].gradient == distance.gradient);
      }
    });
}

TEST(Contacts, NothingTouchesAnEmptyDag) {
  const World world(4, {});
  EXPECT_FALSE(overlaps(world.scene, Capsule::sphere({0, 0, 0}, 1000)));
  EXPECT_FALSE(overlaps(world.scene, OrientedBox{{0, 0, 0}, {9, 9, 9}}));
  EXPECT_FALSE(sweep(world.scene, Capsule::sphere({0, 0, 0}, 1), {5, 5, 5}).hit);
  EXPECT_FALSE(closest(world.scene, Capsule::sphere({0, 0, 0}, 1)).is_found);
}

TEST(Contacts, WhatIsNoShapeIsRefusedWithItsNumber) {
  const World world(4, {{1, 2, 3}});
  const double nan = std::nan("");
  const auto message = [&](Vec3d from, Vec3d to, double radius, Vec3d motion) {
    return error_of([&] {
      const std::vector<Capsule> shapes{{}, {from, to, radius}};
      const std::vector<Vec3d> motions{{}, motion};
      std::vector<SweepHit> hits(2);
      sweep(world.scene, shapes, motions, hits);
    });
  };
  EXPECT_EQ(message({nan, 0, 0}, {}, 1, {}), "shape 1: a point is not finite");
  EXPECT_EQ(message({}, {0, 0, kNever}, 1, {}), "shape 1: a point is not finite");
  EXPECT_EQ(message({}, {}, -1, {}), "shape 1: the radius is negative");
  EXPECT_EQ(message({}, {}, nan, {}), "shape 1: the radius is not finite");
  EXPECT_EQ(message({}, {}, 1, {0, nan, 0}), "shape 1: the motion is not finite");
  EXPECT_EQ(message({1e13, 0, 0}, {}, 1, {}), "shape 1: a point is more than 2^40 voxels");
  EXPECT_EQ(error_of([&] { closest(world.scene, Capsule{}, nan); }),
            "the limit of distances is not a number");
  EXPECT_EQ(error_of([&] { signed_distance(world.scene, {}, -1); }),
            "the limit of distances is negative");
  EXPECT_EQ(error_of([&] {
              overlaps(world.scene, OrientedBox{{}, {-1, 1, 1}});
            }),
            "the size of the box is negative");
  OrientedBox box{{}, {1, 1, 1}};
  box.axes[1] = {0, 2, 0};
  EXPECT_EQ(error_of([&] { overlaps(world.scene, box); }),
            "the axes of the box do not have unit length");
  box.axes[1] = {1, 0, 0};
  EXPECT_EQ(error_of([&] { overlaps(world.scene, box); }),
            "the axes of the box are not at right angles");
}

TEST(Contacts, ALongBoxWhoseAxisIsALittleShortEndsWhereItEnds) {
  const Svdag dag = brute_svdag(4, {{6, 0, 1}});
  Grid grid;
  grid.levels = 4;
  grid.voxel_size = 1;
  OrientedBox box{{-(1e7 - 9) + 3.5, 4, 4}, {1e7, 100, 100}};
  box.axes[0].x = 1 - 9e-7;  // It ends at x = 3.5.
  EXPECT_FALSE(overlaps({dag.view(), grid}, box));
}

}  // namespace
}  // namespace voxdag
