// Rays that a section limits, against rays at a scene that holds only the voxels of the section,
// and against a walk that knows the part of the ray in the section in double.
#include "voxdag/trace/ray_section.hpp"

#include <gtest/gtest.h>

#include <random>

#include "reference_dda.hpp"
#include "support/brute_svdag.hpp"
#include "support/test_rays.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {
namespace {

Grid section_grid(int levels) {
  Grid grid;
  grid.levels = levels;
  grid.origin = {-3.7, 11.3, 0.1};
  grid.voxel_size = 0.0371;
  return grid;
}

Hit cast_hit(const SvdagNodes& nodes, const Grid& grid, const GridRay& ray) {
  CellHit cell;
  if (!cast(nodes, ray, StopAtVoxels{}, cell)) return {};
  return to_hit(ray, cell, grid.levels, 0, HUGE_VALF);
}

/// Calls visit(grid ray) for `count` rays of every kind.
template <class Visit>
void each_ray(const Grid& grid, int count, unsigned seed, const Visit& visit) {
  TestRays rays(grid, seed);
  for (int i = 0; i < count; ++i)
    for (int kind = 0; kind < static_cast<int>(RayKind::kCount); ++kind) {
      visit(make_grid_ray(grid, rays.make(static_cast<RayKind>(kind))));
      if (testing::Test::HasFailure()) return;
    }
}

/// Returns a box of voxels that is not empty.
Box3i random_box(int levels, std::mt19937& rng) {
  Box3i box;
  for (int axis = 0; axis < 3; ++axis) {
    std::uniform_int_distribution<std::int32_t> side(0, 1 << levels);
    do {
      box.lo[axis] = side(rng);
      box.hi[axis] = side(rng);
    } while (box.lo[axis] >= box.hi[axis]);
  }
  return box;
}

TEST(RaySection, ABoxOfVoxelsHidesAllOthers) {
  int hits = 0;
  for (int levels = 2; levels <= 5; ++levels) {
    const Grid grid = section_grid(levels);
    std::mt19937 rng(static_cast<unsigned>(levels));
    for (const NamedVoxels& set : voxel_sets(levels, 7)) {
      SCOPED_TRACE(set.name + " at level " + std::to_string(levels));
      const Svdag whole = brute_svdag(levels, set.voxels);
      const SvdagNodes nodes(whole.view());
      for (int i = 0; i < 4; ++i) {
        const Box3i box = random_box(levels, rng);
        std::vector<Vec3i> inside;
        for (const Vec3i v : set.voxels)
          if (v.x >= box.lo.x && v.y >= box.lo.y && v.z >= box.lo.z && v.x < box.hi.x &&
              v.y < box.hi.y && v.z < box.hi.z)
            inside.push_back(v);
        const Svdag part = brute_svdag(levels, inside);
        const SvdagNodes part_nodes(part.view());
        RaySection section;
        section.is_on = true;
        const float scale = 1.0f / static_cast<float>(1 << levels);
        section.low = static_cast<Vec3f>(box.lo) * scale + Vec3f{1, 1, 1};
        section.high = static_cast<Vec3f>(box.hi) * scale + Vec3f{1, 1, 1};
        each_ray(grid, 200, static_cast<unsigned>(7 + i), [&](const GridRay& ray) {
          GridRay limited = ray;
          limit_to(section, limited);
          Hit hit = cast_hit(nodes, grid, limited);
          const Hit expected = cast_hit(part_nodes, grid, ray);
          // A ray that starts at a side of the section has not entered a voxel there.
          if (limited.t_min > ray.t_min && hit.hit && hit.t == expected.t) hit.face = expected.face;
          EXPECT_TRUE(hit == expected);
          hits += hit.hit ? 1 : 0;
        });
      }
    }
  }
  EXPECT_GT(hits, 5000);
}

/// Returns the first T at which the ray is in the set and below the plane, as far as double tells:
/// infinity if it never is. The plane is `slack` higher.
double first_below(const DenseSet& set, const GridRay& ray, const RaySection& section,
                   double slack) {
  // The ray in grid coordinates.
  Vec3d start, speed;
  for (int axis = 0; axis < 3; ++axis) {
    const bool is_mirrored = (ray.mirrored >> axis & 1u) != 0;
    const double at = static_cast<double>(ray.origin[axis]);
    start[axis] = is_mirrored ? 3 - at : at;
    speed[axis] = (ray.parallel >> axis & 1u) != 0
                      ? 0
                      : (is_mirrored ? 1 : -1) / static_cast<double>(ray.inverse[axis]);
  }
  const double n = 1 << set.levels();
  double first = HUGE_VAL;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        if (!set.contains({x, y, z})) continue;
        double enter = static_cast<double>(ray.t_min), leave = static_cast<double>(ray.t_max);
        const Vec3d low = Vec3d{x / n, y / n, z / n} + Vec3d{1, 1, 1};
        for (int axis = 0; axis < 3; ++axis) {
          const double a = low[axis] - start[axis], b = a + 1 / n;
          if (speed[axis] == 0) {
            if (a > 0 || b <= 0) leave = -1;
            continue;
          }
          enter = std::max(enter, std::min(a / speed[axis], b / speed[axis]));
          leave = std::min(leave, std::max(a / speed[axis], b / speed[axis]));
        }
        const double height = section.height + slack - dot(section.normal, start);
        const double along = dot(section.normal, speed);
        if (along > 0) leave = std::min(leave, height / along);
        if (along < 0) enter = std::max(enter, height / along);
        if (along == 0 && height < 0) leave = -1;
        // A voxel that the ray only touches does not count, as far as the slack goes.
        if (leave - enter > std::max(0.0, -slack)) first = std::min(first, enter);
      }
  return first;
}

TEST(RaySection, APlaneHidesWhatIsAboveIt) {
  constexpr int kLevels = 3;
  constexpr double kSlack = 1e-5;
  const Grid grid = section_grid(kLevels);
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> component(-1, 1), place(1, 2);
  int hits = 0, hidden = 0;
  for (const NamedVoxels& set : voxel_sets(kLevels, 5)) {
    SCOPED_TRACE(set.name);
    const Svdag dag = brute_svdag(kLevels, set.voxels);
    const SvdagNodes nodes(dag.view());
    const DenseSet dense(kLevels, set.voxels);
    for (int i = 0; i < 6; ++i) {
      RaySection section;
      section.is_on = true;
      section.normal = normalized(Vec3d{component(rng), component(rng), component(rng)});
      if (i == 0) section.normal = {0, -1, 0};
      section.height = dot(section.normal, Vec3d{place(rng), place(rng), place(rng)});
      each_ray(grid, 12, static_cast<unsigned>(i), [&](const GridRay& ray) {
        if (ray.misses()) return;
        const double least = first_below(dense, ray, section, kSlack),
                     most = first_below(dense, ray, section, -kSlack);
        GridRay limited = ray;
        limit_to(section, limited);
        CellHit hit;
        const bool is_hit = cast(nodes, limited, StopAtVoxels{}, hit);
        const double t = is_hit ? static_cast<double>(hit.t) : HUGE_VAL;
        EXPECT_GE(t, least - 1e-3);
        EXPECT_LE(t, most + 1e-3);
        hits += is_hit ? 1 : 0;
        CellHit of_whole;
        hidden +=
            cast(nodes, ray, StopAtVoxels{}, of_whole) && (!is_hit || of_whole.t != hit.t) ? 1 : 0;
      });
    }
  }
  EXPECT_GT(hits, 500);
  EXPECT_GT(hidden, 500);
}

TEST(RaySection, ACutFacesTheRay) {
  const Grid grid = section_grid(4);
  const GridRay ray =
      make_grid_ray(grid, grid.origin - Vec3d{1, -0.1, -0.1}, {1, 0.01, 0.02}, 0, HUGE_VAL);
  RaySection section;
  GridRay limited = ray;
  limit_to(section, limited);
  EXPECT_EQ(limited.t_min, ray.t_min);
  EXPECT_EQ(cut_normal(section, limited), Vec3f{});
  section.is_on = true;
  section.low.x = 1.25f;
  limit_to(section, limited);
  EXPECT_EQ(cut_normal(section, limited), (Vec3f{-1, 0, 0}));
  section.normal = {-1, 0, 0};
  section.height = -1.5;
  limited = ray;
  limit_to(section, limited);
  EXPECT_EQ(cut_normal(section, limited), (Vec3f{-1, 0, 0}));
  EXPECT_NEAR(limited.t_min, 0.5, 1e-6);
  // From the other side the ray begins in what remains, and ends at the plane.
  section.normal = {1, 0, 0};
  section.height = 1.5;
  section.low.x = 1;
  limited = ray;
  limit_to(section, limited);
  EXPECT_EQ(cut_normal(section, limited), Vec3f{});
  EXPECT_NEAR(limited.t_max, 0.5, 1e-6);
}

}  // namespace
}  // namespace voxdag
