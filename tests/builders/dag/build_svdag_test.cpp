#include "voxdag/builders/dag/build_svdag.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <random>

#include "support/brute_svdag.hpp"
#include "support/random_triangles.hpp"
#include "support/with_threads.hpp"
#include "voxdag/builders/voxelize/overlap.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"
#include "voxdag/stored/svdag/validate_svdag.hpp"

namespace voxdag {
namespace {

/// Returns a grid whose voxels are world units.
Grid unit_grid(int levels) {
  const double n = static_cast<double>(std::int64_t{1} << levels);
  return grid_from_bounds(Box3d{{0, 0, 0}, {n, n, n}}, levels);
}

Mesh mesh_of(const std::vector<QuantizedTriangle>& triangles) {
  Mesh mesh;
  for (const QuantizedTriangle& t : triangles) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int corner = 0; corner < 3; ++corner)
      mesh.vertices.push_back(static_cast<Vec3f>(t[corner]) * (1.0f / kSubvoxels));
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

/// Tests every voxel of the grid by the definition, then merges by the slow reference builder.
Svdag brute_force(const std::vector<QuantizedTriangle>& triangles, int levels) {
  std::vector<Vec3i> voxels;
  const std::int32_t last = (1 << levels) - 1;
  for (const QuantizedTriangle& t : triangles) {
    const Vec3i lo = min(t.x, min(t.y, t.z)), hi = max(t.x, max(t.y, t.z));
    for (std::int32_t z = std::max(0, lo.z >> 8); z <= std::min(last, hi.z >> 8); ++z)
      for (std::int32_t y = std::max(0, lo.y >> 8); y <= std::min(last, hi.y >> 8); ++y)
        for (std::int32_t x = std::max(0, lo.x >> 8); x <= std::min(last, hi.x >> 8); ++x)
          if (triangle_overlaps_cube(t.x, t.y, t.z, Vec3l{x, y, z} * std::int64_t{kSubvoxels},
                                     kSubvoxels))
            voxels.push_back({x, y, z});
  }
  return brute_svdag(levels, voxels);
}

std::vector<QuantizedTriangle> random_triangles(std::mt19937_64& random, int levels, int count) {
  std::vector<QuantizedTriangle> triangles;
  for (int i = 0; i < count; ++i) triangles.push_back(random_triangle(random, levels));
  return triangles;
}

TEST(BuildSvdag, IsTheMinimalDagOfTheBruteForceCover) {
  std::mt19937_64 random(1);
  for (int round = 0; round < 400; ++round) {
    const int levels = 2 + round % 5;
    const auto triangles = random_triangles(random, levels, 1 + static_cast<int>(random() % 6));
    const Svdag expected = brute_force(triangles, levels);
    const Mesh mesh = mesh_of(triangles);
    ASSERT_EQ(build_svdag(mesh, unit_grid(levels)).dag, expected) << "round " << round;
    ASSERT_EQ(build_svdag(mesh, unit_grid(levels), BuildMethod::kSort).dag, expected)
        << "round " << round;
  }
}

TEST(BuildSvdag, LargePlanarTrianglesGoThroughTheMemoUnchanged) {
  std::mt19937_64 random(2);
  for (int round = 0; round < 12; ++round) {
    const int levels = 7;
    const auto coordinate = [&](std::int32_t below) {
      return static_cast<std::int32_t>(random() % static_cast<unsigned>(below));
    };
    std::vector<QuantizedTriangle> triangles;
    for (int i = 0; i < 2; ++i) {
      QuantizedTriangle t;
      for (int corner = 0; corner < 3; ++corner)
        for (int axis = 0; axis < 3; ++axis) t[corner][axis] = coordinate(kSubvoxels << levels);
      // Steep, gentle and axis-aligned slopes.
      if (round % 3 == 1)
        for (int corner = 0; corner < 3; ++corner) t[corner].z = 9000 + coordinate(2048);
      if (round % 3 == 2) t.y.x = t.z.x = t.x.x;
      triangles.push_back(t);
    }
    const Svdag expected = brute_force(triangles, levels);
    ASSERT_EQ(build_svdag(mesh_of(triangles), unit_grid(levels)).dag, expected);
    ASSERT_EQ(build_svdag(mesh_of(triangles), unit_grid(levels), BuildMethod::kSort).dag, expected);
  }
}

TEST(BuildSvdag, TrianglesManyTimesLargerThanTheGridAreExactInIt) {
  std::mt19937_64 random(7);
  for (int round = 0; round < 120; ++round) {
    const int levels = 5;
    // From edges that fit 32-bit sums to edges that need 64-bit sums.
    const int log2_size = 14 + round % 15;
    const auto coordinate = [&](int log2_below) {
      const auto value = static_cast<std::int32_t>(random() & ((1u << log2_below) - 1));
      return value & ~0x3F;  // exact as a float
    };
    std::vector<QuantizedTriangle> triangles;
    for (int i = 0; i < 3; ++i) {
      QuantizedTriangle t;
      for (int axis = 0; axis < 3; ++axis) {
        const std::int32_t half = 1 << (log2_size - 1);
        std::int32_t inside = coordinate(levels + 8);
        // Through corners of voxels: ties that rounded numbers could not decide.
        if (round % 2 == 1) inside &= -kSubvoxels;
        t.x[axis] = inside + coordinate(log2_size) - half;
        t.y[axis] = inside + coordinate(log2_size) - half;
        t.z[axis] = 3 * inside - t.x[axis] - t.y[axis];
      }
      triangles.push_back(t);
    }
    const Svdag expected = brute_force(triangles, levels);
    const Mesh mesh = mesh_of(triangles);
    ASSERT_EQ(build_svdag(mesh, unit_grid(levels)).dag, expected) << "round " << round;
    ASSERT_EQ(build_svdag(mesh, unit_grid(levels), BuildMethod::kSort).dag, expected)
        << "round " << round;
  }
}

TEST(BuildSvdag, BothMethodsAgreeWhereNoDenseGridFits) {
  std::mt19937_64 random(3);
  for (const int levels : {9, 11, 12}) {
    const Mesh mesh = mesh_of(random_triangles(random, levels, 12));
    const Svdag dag = build_svdag(mesh, unit_grid(levels)).dag;
    EXPECT_FALSE(dag.view().is_empty());
    EXPECT_EQ(build_svdag(mesh, unit_grid(levels), BuildMethod::kSort).dag, dag);
    validate_svdag(dag.view());
    check_canonical(dag.view());
    check_minimal(dag.view());
  }
}

TEST(BuildSvdag, TheWordsDependOnNeitherThreadsNorVectorWidth) {
  std::mt19937_64 random(4);
  const int levels = 10;
  const Mesh mesh = mesh_of(random_triangles(random, levels, 60));
  const Svdag expected = build_svdag(mesh, unit_grid(levels)).dag;
  for (const int threads : {1, 2, 7}) {
    with_threads(threads, [&] {
      EXPECT_EQ(build_svdag(mesh, unit_grid(levels)).dag, expected) << threads << " threads";
      EXPECT_EQ(build_svdag(mesh, unit_grid(levels), BuildMethod::kSort).dag, expected)
          << threads << " threads";
    });
  }
  for (const auto target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    EXPECT_EQ(build_svdag(mesh, unit_grid(levels)).dag, expected) << hwy::TargetName(target);
    EXPECT_EQ(build_svdag(mesh, unit_grid(levels), BuildMethod::kSort).dag, expected)
        << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST(BuildSvdag, TrianglesOutsideTheGridGiveNoVoxels) {
  const Mesh outside{{{20, 20, 20}, {30, 20, 20}, {20, 30, 20}}, {{0, 1, 2}}, {}, {}};
  for (const BuildMethod method :
       {BuildMethod::kHashConsed, BuildMethod::kSort, BuildMethod::kPaper}) {
    const Svdag dag = build_svdag(outside, unit_grid(4), method).dag;
    EXPECT_TRUE(dag.view().is_empty());
    EXPECT_EQ(count_svdag(dag.view()).voxels, 0u);
    validate_svdag(dag.view());
  }
}

TEST(BuildSvdag, ATriangleThatReachesFarOutOfTheGridIsClipped) {
  // The plane y = 5.5 through the whole grid, by a triangle far larger than 32-bit units.
  const Mesh mesh{
      {{-1e9f, 5.5f, -1e9f}, {1e9f, 5.5f, -1e9f}, {0, 5.5f, 1e9f}}, {{0, 1, 2}}, {}, {}};
  for (const BuildMethod method :
       {BuildMethod::kHashConsed, BuildMethod::kSort, BuildMethod::kPaper}) {
    const Svdag dag = build_svdag(mesh, unit_grid(6), method).dag;
    EXPECT_EQ(count_svdag(dag.view()).voxels, 64u * 64u);
  }
}

TEST(BuildSvdag, AnAxisAlignedPlaneTakesOneNodeALevelAtTheLargestGrid) {
  const float n = 1048576;
  const Mesh mesh{{{0, 7, 0}, {n, 7, 0}, {n, 7, n}, {0, 7, n}}, {{0, 1, 2}, {0, 2, 3}}, {}, {}};
  const Svdag dag = build_svdag(mesh, unit_grid(20)).dag;
  const SvdagCounts counts = count_svdag(dag.view());
  EXPECT_EQ(counts.voxels, std::uint64_t{1} << 40);
  EXPECT_EQ(counts.dag_nodes(), 20u);
}

TEST(BuildSvdag, RefusesAMemoryLimitItCannotKeep) {
  std::mt19937_64 random(5);
  const Mesh mesh = mesh_of(random_triangles(random, 12, 40));
  for (const BuildMethod method :
       {BuildMethod::kHashConsed, BuildMethod::kSort, BuildMethod::kPaper}) {
    MemoryBudget memory(1000);
    try {
      build_svdag(mesh, unit_grid(12), method, &memory);
      FAIL();
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("memory limit"), std::string::npos);
    }
  }
}

TEST(BuildSvdag, TheResultCountsInTheGivenBudgetOnly) {
  std::mt19937_64 random(7);
  const Mesh mesh = mesh_of(random_triangles(random, 4, 10));
  EXPECT_EQ(build_svdag(mesh, unit_grid(4)).memory.bytes(), 0u);
  MemoryBudget memory;
  {
    const BuildResult result = build_svdag(mesh, unit_grid(4), BuildMethod::kHashConsed, &memory);
    EXPECT_EQ(memory.used(), result.dag.view().bytes());
  }
  EXPECT_EQ(memory.used(), 0u);
}

TEST(BuildSvdag, StopsWhenCancelled) {
  std::mt19937_64 random(6);
  const Mesh mesh = mesh_of(random_triangles(random, 12, 40));
  for (const BuildMethod method :
       {BuildMethod::kHashConsed, BuildMethod::kSort, BuildMethod::kPaper}) {
    Progress progress;
    progress.cancel();
    EXPECT_THROW(build_svdag(mesh, unit_grid(12), method, &progress), Cancelled);
  }
}

}  // namespace
}  // namespace voxdag
