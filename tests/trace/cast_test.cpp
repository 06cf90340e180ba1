// Compares the octree traversal with walks of the same rays without a tree.
#include "voxdag/trace/cast.hpp"

#include <gtest/gtest.h>

#include <cstdio>

#include "reference_dda.hpp"
#include "support/brute_svdag.hpp"
#include "support/test_rays.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {
namespace {

/// Returns a plain grid, in which lattice points are exact, or a grid with an awkward placement.
Grid test_grid(int levels, bool is_plain) {
  Grid grid;
  grid.levels = levels;
  if (!is_plain) {
    grid.origin = {-3.7, 11.3, 0.1};
    grid.voxel_size = 0.0371;
  }
  return grid;
}

std::string describe(const Ray& ray, const Hit& hit, const Hit& expected) {
  char text[512];
  const auto a = [](float f) { return static_cast<double>(f); };
  std::snprintf(text, sizeof text,
                "origin %a %a %a direction %a %a %a range %a %a\n"
                " got %d at %a voxel %d %d %d face %d, expected %d at %a voxel %d %d %d face %d",
                a(ray.origin.x), a(ray.origin.y), a(ray.origin.z), a(ray.direction.x),
                a(ray.direction.y), a(ray.direction.z), a(ray.t_min), a(ray.t_max), hit.hit,
                a(hit.t), hit.voxel.x, hit.voxel.y, hit.voxel.z, static_cast<int>(hit.face),
                expected.hit, a(expected.t), expected.voxel.x, expected.voxel.y, expected.voxel.z,
                static_cast<int>(expected.face));
  return text;
}

/// Casts `count` rays of every kind at `voxels` and expects the hits of `reference(set, ray, t_min,
/// t_max)`. Returns the number of hits.
template <class Set, class Reference>
int expect_same_hits(const Grid& grid, const std::vector<Vec3i>& voxels, int count, unsigned seed,
                     const Reference& reference) {
  const Svdag dag = brute_svdag(grid.levels, voxels);
  const SvdagNodes nodes(dag.view());
  const Set set(grid.levels, voxels);
  TestRays rays(grid, seed);
  int hits = 0;
  for (int i = 0; i < count; ++i) {
    for (int kind = 0; kind < static_cast<int>(RayKind::kCount); ++kind) {
      const Ray ray = rays.make(static_cast<RayKind>(kind));
      const Hit hit = closest_hit(nodes, grid, ray);
      const Hit expected = reference(set, make_grid_ray(grid, ray), ray.t_min, ray.t_max);
      if (hit != expected || any_hit(nodes, grid, ray) != expected.hit) {
        ADD_FAILURE() << "kind " << kind << ": " << describe(ray, hit, expected);
        return hits;
      }
      hits += hit.hit ? 1 : 0;
    }
  }
  return hits;
}

constexpr auto kDda = [](const auto& set, const GridRay& ray, float t_min, float t_max) {
  return reference_dda(set, ray, t_min, t_max);
};

TEST(Cast, EqualsTheDdaOnSmallGrids) {
  // 12 sets x 8 kinds x 2 placements x 3 sizes x 1100 = 633,600 rays.
  for (int levels = 2; levels <= 4; ++levels)
    for (const bool is_plain : {true, false})
      for (const NamedVoxels& set : voxel_sets(levels, 7)) {
        SCOPED_TRACE(set.name + " at level " + std::to_string(levels));
        expect_same_hits<DenseSet>(test_grid(levels, is_plain), set.voxels, 1100, 11, kDda);
      }
}

TEST(Cast, EqualsTheDdaOnLargerGrids) {
  // 12 sets x 8 kinds x 2 placements x 3 sizes x 900 = 518,400 rays.
  int hits = 0;
  for (int levels = 5; levels <= 7; ++levels) {
    for (const NamedVoxels& set : voxel_sets(levels, 9))
      for (const bool is_plain : {true, false}) {
        SCOPED_TRACE(set.name + " at level " + std::to_string(levels));
        hits += expect_same_hits<DenseSet>(test_grid(levels, is_plain), set.voxels, 900, 13, kDda);
      }
  }
  EXPECT_GT(hits, 100'000) << "too few of the rays met anything to prove much";
}

TEST(Cast, VisitsExactlyTheVoxelsOfTheDefinition) {
  for (int levels = 2; levels <= 4; ++levels)
    for (const NamedVoxels& set : voxel_sets(levels, 3))
      expect_same_hits<DenseSet>(test_grid(levels, true), set.voxels, 100, 17,
                                 [](const auto& s, const GridRay& ray, float t_min, float t_max) {
                                   return reference_by_definition(s, ray, t_min, t_max);
                                 });
}

/// Returns a patch of a rough slab of voxels in the middle of the grid. It is dense enough for rays
/// at that point to hit, and small enough for the brute-force builder.
std::vector<Vec3i> rough_patch(int levels) {
  std::mt19937 rng(5);
  std::vector<Vec3i> voxels = random_voxels(levels, 2000, 5);
  const std::int32_t middle = 1 << (levels - 1);
  for (std::int32_t y = -40; y < 40; ++y)
    for (std::int32_t x = -40; x < 40; ++x)
      voxels.push_back({middle + x, middle + y, middle + static_cast<std::int32_t>(rng() % 3)});
  return voxels;
}

TEST(Cast, EqualsTheDdaOnHugeGrids) {
  int hits = 0;
  for (const int levels : {12, 17, 20}) {
    const Grid grid = test_grid(levels, false);
    const std::vector<Vec3i> voxels = rough_patch(levels);
    // Rays of all kinds; not many of them meet one of the few voxels.
    expect_same_hits<SparseSet>(grid, voxels, levels == 20 ? 12 : 100, 19, kDda);

    // Short rays near the patch meet it.
    const Svdag dag = brute_svdag(levels, voxels);
    const SvdagNodes nodes(dag.view());
    const SparseSet set(levels, voxels);
    std::mt19937 rng(static_cast<unsigned>(levels));
    std::uniform_real_distribution<double> offset(-60, 60), component(-1, 1);
    const double half = static_cast<double>(grid.resolution()) / 2;
    const Vec3d middle{half, half, half};
    for (int i = 0; i < 20000; ++i) {
      const Vec3d from = middle + Vec3d{offset(rng), offset(rng), offset(rng)};
      const Vec3d direction{component(rng), component(rng), component(rng)};
      const GridRay ray =
          make_grid_ray(grid, grid.to_world(from), direction * grid.voxel_size, 0, 200);
      CellHit cell;
      Hit hit;
      if (cast(nodes, ray, StopAtVoxels{}, cell)) hit = to_hit(ray, cell, levels, 0, 200);
      ASSERT_EQ(hit, reference_dda(set, ray, 0, 200));
      hits += hit.hit ? 1 : 0;
    }
  }
  EXPECT_GT(hits, 5'000);
}

}  // namespace
}  // namespace voxdag
