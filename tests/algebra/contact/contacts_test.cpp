// Contacts against loops over all voxels, with other formulas.
#include "voxdag/algebra/contact/contacts.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>

#include "algebra/voxel_grid.hpp"
#include "support/brute_svdag.hpp"
#include "support/error_of.hpp"
#include "support/voxel_sets.hpp"
#include "support/with_threads.hpp"
#include "voxdag/edit/editable_dag.hpp"

namespace voxdag {
namespace {

constexpr double kNone = HUGE_VAL;

/// Returns the point of the cube of a voxel that is nearest to a point. Units are voxels.
Vec3d nearest_in(Vec3i voxel, Vec3d p) {
  for (int axis = 0; axis < 3; ++axis)
    p[axis] = std::clamp(p[axis], double(voxel[axis]), double(voxel[axis]) + 1);
  return p;
}
double point_gap(Vec3i voxel, Vec3d p) { return length(p - nearest_in(voxel, p)); }

/// Returns the distance from a segment to the cube of a voxel: the least of the distances at its
/// ends and at the least points of all 27 sums of squares that the squared distance consists of.
double segment_gap(Vec3i voxel, Vec3d from, Vec3d to) {
  const Vec3d along = to - from;
  double least = std::min(point_gap(voxel, from), point_gap(voxel, to));
  for (int pattern = 0; pattern < 27; ++pattern) {
    double squares = 0, products = 0;
    for (int axis = 0, rest = pattern; axis < 3; ++axis, rest /= 3) {
      if (rest % 3 == 0) continue;
      const double plane = voxel[axis] + rest % 3 - 1;
      squares += along[axis] * along[axis];
      products += along[axis] * (plane - from[axis]);
    }
    if (squares > 0)
      least =
          std::min(least, point_gap(voxel, from + along * std::clamp(products / squares, 0., 1.)));
  }
  return least;
}

double gap(Vec3i voxel, const Capsule& shape) {
  return segment_gap(voxel, shape.from, shape.to) - shape.radius;
}

Capsule moved(const Capsule& shape, Vec3d motion) {
  return {shape.from + motion, shape.to + motion, shape.radius};
}

/// Returns the part of a motion after which a capsule touches a voxel that it approaches, kNone if
/// it does not: by bisection, because the gap falls to its least value and then grows. NaN if
/// rounding decides.
double touch_time(Vec3i voxel, const Capsule& shape, Vec3d motion) {
  const auto gap_at = [&](double t) { return gap(voxel, moved(shape, motion * t)); };
  if (gap_at(0) > length(motion)) return kNone;
  double low = 0, high = 1;
  for (int i = 0; i < 60; ++i) {
    const double a = low + (high - low) / 3, b = high - (high - low) / 3;
    const bool is_left = gap_at(a) <= gap_at(b);
    (is_left ? high : low) = is_left ? b : a;
  }
  const double least = gap_at(high);
  if (std::fabs(least) < 1e-6) return std::nan("");
  if (least > 0) return kNone;
  if (gap_at(0) <= 0) {
    if (segment_gap(voxel, shape.from, shape.to) == 0) return 0;
    return high < 1e-6 ? kNone : 0;
  }
  low = 0;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (gap_at(middle) > 0 ? low : high) = middle;
  }
  return low;
}

/// Random shapes in and around a grid of 2^levels, in voxels.
class Shapes {
 public:
  Shapes(int levels, unsigned seed) : side_(1 << levels), random_(seed) {}

  double number(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  Vec3d point() {
    const double reach = 0.3 * side_;
    return {number(-reach, side_ + reach), number(-reach, side_ + reach),
            number(-reach, side_ + reach)};
  }
  Vec3d vector(double most) {
    return {number(-most, most), number(-most, most), number(-most, most)};
  }
  /// Returns points, spheres, segments and capsules.
  Capsule capsule() {
    const Vec3d from = point();
    const int kind = static_cast<int>(random_() % 4);
    return {from, (kind & 1) != 0 ? from + vector(0.4 * side_) : from,
            (kind & 2) != 0 ? number(0, 0.2 * side_) : 0};
  }

 private:
  int side_;
  std::mt19937 random_;
};

/// A grid whose voxels are not of size 1. `world` are functions from voxels to world units.
struct World {
  Svdag dag;
  ContactScene scene;

  World(int levels, const std::vector<Vec3i>& voxels) : dag(brute_svdag(levels, voxels)) {
    scene.dag = dag.view();
    scene.grid.levels = levels;
    scene.grid.origin = {-3, 0.5, 20};
    scene.grid.voxel_size = 0.25;  // Exact, so that voxels stay what they are.
  }
  Vec3d place(Vec3d voxels) const { return scene.grid.to_world(voxels); }
  double size(double voxels) const { return voxels * scene.grid.voxel_size; }
  Capsule shape(const Capsule& voxels) const {
    return {place(voxels.from), place(voxels.to), size(voxels.radius)};
  }
};

constexpr double kClose = 1e-9;  ///< Rounding of coordinates and of two formulas.

TEST(Contacts, TheClosestVoxelIsTheClosestOfAll) {
  for (const NamedVoxels& set : voxel_sets(4, 7)) {
    SCOPED_TRACE(set.name);
    const World world(4, set.voxels);
    Shapes shapes(4, 1);
    for (int i = 0; i < 40; ++i) {
      const Capsule shape = shapes.capsule();
      double least = kNone;
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

TEST(Contacts, ASweepEndsAtTheFirstVoxelThatItMeets) {
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
      double first = kNone;
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
      ASSERT_EQ(hit.hit, first != kNone) << i;
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

TEST(Contacts, SweepsAgainstFacesEdgesAndCornersAreThoseOfGeometry) {
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

TEST(Contacts, AShapeThatTouchesAtTheStartMayLeaveAndSlideButNotApproach) {
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
        double least = kNone;
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
  double least = kNone;
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
        EXPECT_EQ(found.distance, kNone);
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
  EXPECT_EQ(message({}, {0, 0, kNone}, 1, {}), "shape 1: a point is not finite");
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
}

TEST(Contacts, LongMotionsEndAtTheVoxel) {
  const World world(4, {{8, 8, 8}});
  const Vec3d far = world.place({8.5, 8.5, 1e9 + 8.5});
  const SweepHit hit = sweep(world.scene, Capsule::sphere(far, world.size(2)), {0, 0, -1e9});
  ASSERT_TRUE(hit.hit);
  EXPECT_NEAR(hit.t * 1e9, far.z - world.place({0, 0, 11}).z, 1e-6);
}

}  // namespace
}  // namespace voxdag
