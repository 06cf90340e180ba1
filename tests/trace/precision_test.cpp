// Compares hits with the true line, in long double: measures how far the traversal's rounding can
// move a picture.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "reference_dda.hpp"
#include "support/brute_svdag.hpp"
#include "support/test_rays.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {
namespace {

using Real = long double;
using Vec3r = Vec3<Real>;

/// The given ray without the library's rounding, in voxel units.
struct TrueLine {
  Vec3r origin, direction;

  TrueLine(const Grid& grid, const Ray& ray)
      : origin((static_cast<Vec3r>(ray.origin) - static_cast<Vec3r>(grid.origin)) *
               (1 / static_cast<Real>(grid.voxel_size))),
        direction(static_cast<Vec3r>(ray.direction) * (1 / static_cast<Real>(grid.voxel_size))) {}

  Vec3r at(Real t) const { return origin + direction * t; }
  Real speed() const { return std::sqrt(dot(direction, direction)); }
};

/// Returns the tolerance. The traversal rounds origins by at most 2^-24 and directions by at most
/// 2^-23 of the grid. A float t has an error of 2^-24 of its size, which is up to four grids. The
/// sum is at most 2^-21 N voxels.
Real tolerance_voxels(const Grid& grid) {
  return std::ldexp(static_cast<Real>(grid.resolution()), -21);
}

/// Returns the depth of p inside the voxel; negative outside.
Real depth_voxels(Vec3r p, Vec3i voxel) {
  Real depth = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const Real low = static_cast<Real>(voxel[axis]);
    depth = std::min({depth, p[axis] - low, low + 1 - p[axis]});
  }
  return depth;
}

/// Expects that the point at hit.t is in the hit voxel.
void expect_hit_point_in_voxel(const Grid& grid, const Ray& ray, const Hit& hit) {
  const Vec3r p = TrueLine(grid, ray).at(static_cast<Real>(hit.t));
  EXPECT_GE(depth_voxels(p, hit.voxel), -tolerance_voxels(grid));
}

/// Expects that before `t_end` the true line enters no voxel of `set` by more than the tolerance.
template <class Set>
void expect_nothing_missed(const Grid& grid, const Set& set, const Ray& ray, Real t_end) {
  const TrueLine line(grid, ray);
  const Real slack = tolerance_voxels(grid) / line.speed();
  const auto n = static_cast<Real>(grid.resolution());
  Real t = static_cast<Real>(ray.t_min), end = std::min(t_end, static_cast<Real>(ray.t_max));
  for (int axis = 0; axis < 3; ++axis) {
    const Real a = -line.origin[axis] / line.direction[axis];
    const Real b = (n - line.origin[axis]) / line.direction[axis];
    t = std::max(t, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  end -= slack;
  while (t < end) {
    // Finds the next voxel, and the t at which the line leaves it.
    const Vec3r ahead = line.at(t + slack / 8);
    Vec3i voxel;
    Real leave = end;
    for (int axis = 0; axis < 3; ++axis) {
      const Real low = std::floor(ahead[axis]);
      voxel[axis] = static_cast<std::int32_t>(low);
      const Real plane = line.direction[axis] > 0 ? low + 1 : low;
      leave = std::min(leave, (plane - line.origin[axis]) / line.direction[axis]);
      if (voxel[axis] < 0 || voxel[axis] >= grid.resolution()) return;
    }
    const Vec3r middle = line.at((t + leave) / 2);
    if (set.contains(voxel) && depth_voxels(middle, voxel) > tolerance_voxels(grid)) {
      ADD_FAILURE() << "missed " << voxel.x << ' ' << voxel.y << ' ' << voxel.z;
      return;
    }
    t = std::max(leave, t + slack / 8);
  }
}

TEST(CastPrecision, HitsLieOnTheTrueLineAndNothingBeforeThemIsMissed) {
  Grid grid;
  grid.levels = 7;
  grid.origin = {1.7, -0.3, 25};
  grid.voxel_size = 0.013;
  for (const NamedVoxels& voxels : voxel_sets(grid.levels, 21)) {
    const Svdag dag = brute_svdag(grid.levels, voxels.voxels);
    const DenseSet set(grid.levels, voxels.voxels);
    TestRays rays(grid, 23);
    for (int i = 0; i < 2000; ++i) {
      const Ray ray = rays.make(RayKind::kGeneric);
      const Hit hit = closest_hit(SvdagNodes(dag.view()), grid, ray);
      if (hit.hit) expect_hit_point_in_voxel(grid, ray, hit);
      expect_nothing_missed(grid, set, ray, static_cast<Real>(hit.hit ? hit.t : ray.t_max));
      if (HasFailure()) FAIL() << voxels.name << ", ray " << i;
    }
  }
}

TEST(CastPrecision, IsWithinASixteenthOfAVoxelAt131072Cubed) {
  Grid grid;
  grid.levels = 17;
  grid.voxel_size = 1.0 / 1024;
  ASSERT_LE(tolerance_voxels(grid), 1.0L / 16);
  const std::int32_t middle = 1 << 16;
  std::vector<Vec3i> voxels;
  for (std::int32_t y = -50; y < 50; ++y)
    for (std::int32_t x = -50; x < 50; ++x)
      voxels.push_back({middle + x, middle + y, middle + (x + y) / 3});
  const Svdag dag = brute_svdag(grid.levels, voxels);
  const SparseSet set(grid.levels, voxels);
  std::mt19937 rng(29);
  std::uniform_real_distribution<double> spread(-50, 50);
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3d target = Vec3d{1, 1, 1} * static_cast<double>(middle) +
                         Vec3d{spread(rng), spread(rng), spread(rng) / 10};
    const Vec3d towards{spread(rng), spread(rng), spread(rng)};
    const double distance = i % 50 == 0 ? 500 : 2;  // near the grid, or far away
    Ray ray;
    ray.origin = static_cast<Vec3f>(grid.to_world(target - towards * distance));
    ray.direction = static_cast<Vec3f>(grid.to_world(target)) - ray.origin;
    ray.t_max = 2;
    const Hit hit = closest_hit(SvdagNodes(dag.view()), grid, ray);
    if (hit.hit) expect_hit_point_in_voxel(grid, ray, hit);
    expect_nothing_missed(grid, set, ray, static_cast<Real>(hit.hit ? hit.t : ray.t_max));
    if (HasFailure()) FAIL() << "ray " << i;
    hits += hit.hit ? 1 : 0;
  }
  EXPECT_GT(hits, 5000);
}

TEST(CastPrecision, RaysFromAfarThatAreNearlyParallelToAnAxisMeetTheVoxelsOfTheirLine) {
  Grid grid;
  grid.levels = 7;
  std::vector<Vec3i> wall;
  for (std::int32_t z = 0; z < 128; ++z)
    for (std::int32_t y = 0; y < 128; ++y) wall.push_back({64, y, z});
  const Svdag dag = brute_svdag(grid.levels, wall);
  std::mt19937 rng(31);
  std::uniform_real_distribution<float> anywhere(-8, 136), log2_slope(-45, -28);
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {
    Ray ray;
    ray.origin = {i % 2 == 0 ? -3e9f : 3e9f, anywhere(rng), anywhere(rng)};
    const auto slope = [&] { return std::exp2(log2_slope(rng)) * (rng() % 2 == 0 ? 1.0f : -1.0f); };
    ray.direction = {i % 2 == 0 ? 1.0f : -1.0f, slope(), slope()};
    ray.t_max = std::numeric_limits<float>::infinity();
    const TrueLine line(grid, ray);
    const Vec3r p = line.at((64.5L - line.origin.x) / line.direction.x);
    const auto is_near_plane = [](Real at) { return std::fabs(at - std::round(at)) < 1e-4L; };
    if (is_near_plane(p.y) || is_near_plane(p.z)) continue;
    const Hit hit = closest_hit(SvdagNodes(dag.view()), grid, ray);
    const bool is_inside = p.y > 0 && p.y < 128 && p.z > 0 && p.z < 128;
    ASSERT_EQ(hit.hit, is_inside) << "ray " << i;
    if (!is_inside) continue;
    ASSERT_EQ(hit.voxel,
              (Vec3i{64, static_cast<std::int32_t>(p.y), static_cast<std::int32_t>(p.z)}))
        << "ray " << i;
    ++hits;
  }
  EXPECT_GT(hits, 10000);
}

}  // namespace
}  // namespace voxdag
