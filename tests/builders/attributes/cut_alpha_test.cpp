#include "voxdag/builders/attributes/cut_alpha.hpp"

#include <gtest/gtest.h>

#include "support/textured_square.hpp"
#include "support/with_threads.hpp"
#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"
#include "voxdag/stored/svdag/svdag_lookup.hpp"

namespace voxdag {
namespace {

/// A square whose left half is visible; before its right half stands an opaque square half its
/// size.
struct HalfVisible : Square {
  HalfVisible() {
    std::vector<std::uint16_t> samples;
    for (int i = 0; i < 64 * 64; ++i)
      for (const int s : {255, 0, 0, i % 64 < 32 ? 255 : 0})
        samples.push_back(static_cast<std::uint16_t>(s));
    material().color_map = texture("a.png", 64, 64, 4, samples);
    material().alpha_mode = AlphaMode::kMask;
    appearance.materials.emplace_back();
    for (const Vec3f corner : {Vec3f{0.75f, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0.75f, 1, 0}})
      mesh.vertices.push_back(corner);
    mesh.triangles.push_back({4, 5, 6});
    mesh.triangles.push_back({4, 6, 7});
    mesh.triangle_materials = {0, 0, 1, 1};
    appearance.uvs.resize(12);
    grid = fit_grid(mesh, 10);
    dag = build_svdag(mesh, grid).dag;
  }
  Grid grid;
  Svdag dag;
};

TEST(CutAlpha, VoxelsWithoutVisibleSurfaceAreNotSet) {
  const HalfVisible of;
  const auto cut =
      cut_alpha(of.mesh, of.grid, of.dag.view(), SurfaceShading(of.mesh, of.appearance));
  ASSERT_TRUE(cut);
  for (int y = 0; y < 1024; y += 31)
    for (int x = 0; x < 1024; ++x) {
      if (std::abs(x - 512) < 2 || std::abs(x - 768) < 2) continue;  // at an edge
      ASSERT_EQ(svdag_contains(cut->view(), {x, y, 0}, 10), x < 512 || x > 768) << x << ", " << y;
    }
}

TEST(CutAlpha, AnyNumberOfThreadsGivesTheSameVoxels) {
  const HalfVisible of;
  const SurfaceShading shading(of.mesh, of.appearance);
  const auto cut = [&](int threads) {
    return with_threads(threads,
                        [&] { return *cut_alpha(of.mesh, of.grid, of.dag.view(), shading); });
  };
  EXPECT_EQ(cut(1), cut(4));
}

TEST(CutAlpha, ASurfaceThatIsVisibleEverywhereStays) {
  HalfVisible of;
  of.material().alpha_mode = AlphaMode::kOpaque;
  EXPECT_FALSE(cut_alpha(of.mesh, of.grid, of.dag.view(), SurfaceShading(of.mesh, of.appearance)));
}

TEST(CutAlpha, MemoryIsCountedUntilItReturns) {
  const HalfVisible of;
  const SurfaceShading shading(of.mesh, of.appearance);
  MemoryBudget memory;
  cut_alpha(of.mesh, of.grid, of.dag.view(), shading, &memory);
  EXPECT_EQ(memory.used(), 0u);
  MemoryBudget small(1 << 10);
  EXPECT_THROW(cut_alpha(of.mesh, of.grid, of.dag.view(), shading, &small), OverMemory);
}

}  // namespace
}  // namespace voxdag
