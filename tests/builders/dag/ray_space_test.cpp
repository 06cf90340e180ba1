// The space of rays against a walk in fractions along each of them.
#include "voxdag/builders/dag/ray_space.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>
#include <tuple>

#include "support/brute_svdag.hpp"
#include "support/error_of.hpp"
#include "voxdag/core/int128.hpp"

namespace voxdag {
namespace {

using Place = std::tuple<int, int, int>;
using Wide = Int128;

/// A time between 0 and 1 along a ray, exact.
struct Fraction {
  Wide up, down;
  bool operator<(const Fraction& other) const { return up * other.down < other.up * down; }
};

Wide floor_of(Wide up, Wide down) { return up >= 0 ? up / down : -((-up + down - 1) / down); }

/// Adds the voxels that a ray between points in 1/256 voxel passes through.
void add_passed(const Vec3l& from, const Vec3l& to, int side, std::set<Place>& passed) {
  std::vector<Fraction> times{{0, 1}, {1, 1}};
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t step = to[axis] - from[axis];
    for (std::int64_t plane = 0; step != 0 && plane <= side; ++plane) {
      const std::int64_t up = (plane * 256 - from[axis]) * (step < 0 ? -1 : 1);
      if (up >= 0 && up <= std::abs(step)) times.push_back({up, std::abs(step)});
    }
  }
  std::sort(times.begin(), times.end());
  const auto add = [&](const Fraction& t) {
    int voxel[3];
    for (int axis = 0; axis < 3; ++axis) {
      const Wide at = floor_of(from[axis] * t.down + (to[axis] - from[axis]) * t.up, t.down * 256);
      if (at < 0 || at >= side) return;
      voxel[axis] = static_cast<int>(at);
    }
    passed.insert({voxel[0], voxel[1], voxel[2]});
  };
  for (std::size_t i = 0; i < times.size(); ++i) {
    add(times[i]);
    if (i + 1 < times.size())
      add({times[i].up * times[i + 1].down + times[i + 1].up * times[i].down,
           2 * times[i].down * times[i + 1].down});
  }
}

std::vector<Vec3i> list_of(const std::set<Place>& places) {
  std::vector<Vec3i> voxels;
  for (const auto& [x, y, z] : places) voxels.push_back({x, y, z});
  return voxels;
}

constexpr int kLevels = 5, kSide = 32;

/// Voxels of size 1 from 0 to 32.
GridRequest box() {
  GridRequest request;
  request.voxel_size = 1;
  request.bounds = Box3d{{0, 0, 0}, {kSide, kSide, kSide}};
  return request;
}

/// Points in multiples of 1/4 or 1/256 voxel, also outside of the grid.
std::vector<Vec3d> random_points(std::size_t count, unsigned seed) {
  std::mt19937 rng(seed);
  std::vector<Vec3d> points;
  for (std::size_t i = 0; i < count; ++i) {
    const int steps = i % 3 == 0 ? 4 : 256;
    const auto at = [&] {
      return static_cast<double>(rng() % static_cast<unsigned>(44 * steps)) / steps - 6;
    };
    points.push_back({at(), at(), at()});
  }
  return points;
}

void expect_space(const std::vector<Vec3d>& origins, const std::vector<Vec3d>& ends,
                  const std::vector<bool>& hits) {
  std::set<Place> passed, occupied;
  const auto quantized = [](Vec3d p) {
    return Vec3l{std::llround(p.x * 256), std::llround(p.y * 256), std::llround(p.z * 256)};
  };
  for (std::size_t i = 0; i < ends.size(); ++i) {
    const Vec3l end = quantized(ends[i]);
    add_passed(quantized(origins[origins.size() == 1 ? 0 : i]), end, kSide, passed);
    if (hits.empty() || hits[i]) add_passed(end, end, kSide, occupied);
  }
  for (const Place& place : occupied) passed.erase(place);
  const RaySpace space = ray_space(origins, ends, hits, box());
  ASSERT_EQ(space.grid.levels, kLevels);
  EXPECT_EQ(space.occupied, brute_svdag(kLevels, list_of(occupied)));
  EXPECT_EQ(space.free, brute_svdag(kLevels, list_of(passed)));
}

TEST(RaySpace, IsThatOfAWalkInFractions) {
  for (const std::size_t count : {std::size_t{1}, std::size_t{20}, std::size_t{1000}}) {
    const std::vector<Vec3d> origins = random_points(count, 1), ends = random_points(count, 2);
    expect_space(origins, ends, {});
    std::vector<bool> hits;
    for (std::size_t i = 0; i < count; ++i) hits.push_back(i % 3 != 1);
    expect_space(origins, ends, hits);
    expect_space({{7.25, 8, 9.5}}, ends, hits);
  }
}

TEST(RaySpace, RaysAlongAxesAndPlanesBelongToTheUpperVoxels) {
  std::vector<Vec3d> origins, ends;
  for (const double z : {3.0, 3.5})
    for (const Vec3d end : {Vec3d{20, 3, z}, {3, 20, z}, {3, 3, 20}, {20, 20, z}, {3, 3, z}}) {
      origins.push_back({3, 3, z});
      ends.push_back(end);
      origins.push_back(end);
      ends.push_back({3, 3, z});
    }
  expect_space(origins, ends, {});
  expect_space(origins, ends, std::vector<bool>(ends.size(), false));
}

TEST(RaySpace, RowsThatDoNotFitAreRefused) {
  const std::vector<Vec3d> two(2), three(3);
  EXPECT_NE(error_of([&] { ray_space(two, three, {}, box()); }).find("an origin each"),
            std::string::npos);
  EXPECT_NE(error_of([&] { ray_space(two, two, {true}, box()); }).find("whether they hit"),
            std::string::npos);
  const std::vector<Vec3d> far{{0, 0, 0}, {0, HUGE_VAL, 0}};
  EXPECT_NE(error_of([&] { ray_space(two, far, {}, box()); }).find("ray 1 is not finite"),
            std::string::npos);
  EXPECT_TRUE(ray_space({}, {}, {}, box()).free.view().is_empty());
}

}  // namespace
}  // namespace voxdag
