#include "voxdag/builders/voxelize/duplicate_triangles.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>

#include "support/with_threads.hpp"
#include "voxdag/core/grid.hpp"

namespace voxdag {
namespace {

/// Returns a grid whose voxels are world units.
Grid unit_grid() { return grid_from_bounds(Box3d{{0, 0, 0}, {64, 64, 64}}, 6); }

/// Returns `count` triangles with corners among few points, so that many are duplicates.
Mesh crowded_mesh(std::size_t count) {
  std::mt19937 random(1);
  Mesh mesh;
  // Points that quantise to the same integers are also one corner.
  for (int i = 0; i < 40; ++i) {
    const auto x = static_cast<float>(random() % 4) + static_cast<float>(random() % 2) * 1e-4f;
    mesh.vertices.push_back({x, static_cast<float>(random() % 4), 1});
  }
  for (std::size_t i = 0; i < count; ++i)
    mesh.triangles.push_back({static_cast<std::uint32_t>(random() % 40),
                              static_cast<std::uint32_t>(random() % 40),
                              static_cast<std::uint32_t>(random() % 40)});
  return mesh;
}

using Key = std::array<std::array<std::int32_t, 3>, 3>;

Key key_of(const QuantizedTriangle& t) {
  Key key{{{t.x.x, t.x.y, t.x.z}, {t.y.x, t.y.y, t.y.z}, {t.z.x, t.z.y, t.z.z}}};
  std::sort(key.begin(), key.end());
  return key;
}

TEST(FindDuplicateTriangles, AllButTheFirstTriangleWithTheSameCorners) {
  const Mesh mesh = crowded_mesh(20000);
  const QuantizedMesh quantized(mesh, unit_grid());
  for (const int threads : {1, 4}) {
    with_threads(threads, [&] {
      const IndexSet duplicates = find_duplicate_triangles(quantized);
      std::map<Key, std::size_t> first;
      for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        ASSERT_EQ(duplicates.contains(i),
                  !first.try_emplace(key_of(quantized.triangle(i)), i).second)
            << i;
      EXPECT_EQ(duplicates.count(), mesh.triangles.size() - first.size());
    });
  }
}

TEST(FindDuplicateTriangles, NoneTakesNoMemory) {
  const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}, {}, {}};
  MemoryBudget budget;
  const IndexSet duplicates = find_duplicate_triangles(QuantizedMesh(mesh, unit_grid()), &budget);
  EXPECT_FALSE(duplicates.contains(0));
  EXPECT_EQ(budget.used(), 0u);
}

}  // namespace
}  // namespace voxdag
