// Compares the builder's linear conditions with the definition, at every level of the octree.
#include "voxdag/builders/voxelize/triangle_setup.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "support/random_triangles.hpp"
#include "voxdag/builders/voxelize/cell_classify.hpp"
#include "voxdag/builders/voxelize/overlap.hpp"
#include "voxdag/core/morton.hpp"

namespace voxdag {
namespace {

bool overlaps(const QuantizedTriangle& t, Vec3i cell, std::int64_t voxels) {
  return triangle_overlaps_cube(t.x, t.y, t.z, static_cast<Vec3l>(cell) * std::int64_t{kSubvoxels},
                                voxels * kSubvoxels);
}

/// Follows a random path from the root down and compares all eight children on the way.
void check_random_path(std::mt19937_64& random, const QuantizedTriangle& t, int levels,
                       Vec3i origin) {
  const TriangleSetup setup = make_triangle_setup(t, origin);
  std::uint32_t conditions = setup.conditions;
  Vec3i cell{};  // relative to the origin
  for (int log2_size = levels; log2_size > 0; --log2_size) {
    const std::int32_t half = std::int32_t{1} << (log2_size - 1);
    const ChildConditions children = classify_children(setup, conditions, cell, half);
    int next = -1;
    for (int i = 0; i < 8; ++i) {
      const int child = (i + static_cast<int>(random() % 8)) % 8;
      const Vec3i at = cell + child_offset(child) * half;
      const bool expected = overlaps(t, origin + at, half);
      const bool alive = ((children.alive >> child) & 1) != 0;
      // If the plane's 64-bit sums could overflow, the cell is kept and its children decide.
      if (alive && !expected && slab_range(setup, cell, 2 * half) == 2) continue;
      ASSERT_EQ(alive, expected) << "cell of " << half << " voxels at " << at.x << "," << at.y
                                 << "," << at.z;
      if (expected && (next < 0 || random() % 2)) next = child;
    }
    if (next < 0) return;
    conditions = children.conditions(next);
    cell = cell + child_offset(next) * half;
  }
}

TEST(ClassifyChildren, AgreesWithTheDefinitionAtEveryLevelAndSize) {
  std::mt19937_64 random(11);
  for (const int levels : {3, 5, 8, 13, 17, 20})
    for (int round = 0; round < 1500; ++round)
      check_random_path(random, random_triangle(random, levels), levels, {0, 0, 0});
}

TEST(ClassifyChildren, AgreesFromAnOriginInsideTheGrid) {
  std::mt19937_64 random(12);
  for (int round = 0; round < 3000; ++round) {
    const int levels = 17;
    const QuantizedTriangle t = random_triangle(random, levels);
    // A sub-volume of 2^8 voxels around a vertex.
    const Vec3i origin{t.x.x >> 16 << 8, t.x.y >> 16 << 8, t.x.z >> 16 << 8};
    check_random_path(random, t, 8, origin);
  }
}

TEST(MakeTriangleSetup, TheNormalOfAParallelTriangleIsTheSame) {
  const QuantizedTriangle small{{0, 0, 0}, {3, 0, 3}, {0, 5, 0}};
  const QuantizedTriangle large{{100, 0, 700}, {0, 0, 600}, {100, 900, 700}};
  EXPECT_EQ(make_triangle_setup({small.x * 256, small.y * 256, small.z * 256}, {}).plane.normal,
            (Vec3l{1, 0, -1}));
  EXPECT_EQ(make_triangle_setup({large.x * 256, large.y * 256, large.z * 256}, {}).plane.normal,
            (Vec3l{1, 0, -1}));
}

}  // namespace
}  // namespace voxdag
