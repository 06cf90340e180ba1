#include "voxdag/builders/attributes/filter_materials.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>

#include "support/clipped_polygon.hpp"
#include "support/memory_limit.hpp"
#include "support/with_threads.hpp"
#include "voxdag/builders/attributes/build_attributes.hpp"
#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/stored/attributes/build_cell_index.hpp"
#include "voxdag/stored/attributes/material_colors.hpp"
#include "voxdag/stored/attributes/validate_pages.hpp"

namespace voxdag {
namespace {

/// Large triangles of random materials.
struct MaterialMesh {
  Mesh mesh;
  Grid grid;

  MaterialMesh(int triangles, int levels, std::uint32_t materials) {
    std::mt19937 rng(5);
    const auto unit = [&] { return static_cast<float>(rng() >> 8) / 16777216.0f; };
    for (int i = 0; i < triangles; ++i) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (int k = 0; k < 3; ++k) mesh.vertices.push_back({unit(), unit(), unit()});
      mesh.triangles.push_back({first, first + 1, first + 2});
      mesh.triangle_materials.push_back(static_cast<std::uint32_t>(rng() % materials));
    }
    mesh.materials.resize(materials, "name");
    grid = fit_grid(mesh, levels);
  }
  Svdag dag() const { return build_svdag(mesh, grid, {}).dag; }
  MaterialIds filter(const SvdagView& dag, int finest) const {
    return filter_materials(mesh, grid, dag, build_cell_index(dag, finest).view());
  }
};

TEST(FilterMaterials, EveryCellHasTheMaterialWithTheLargestAreaInIt) {
  const int levels = 5;
  const MaterialMesh scene(12, levels, 4);
  const Svdag dag = scene.dag();
  const QuantizedMesh quantized(scene.mesh, scene.grid);
  for (int finest = 2; finest <= levels; ++finest) {
    const CellIndex index = build_cell_index(dag.view(), finest);
    const MaterialIds ids = scene.filter(dag.view(), finest);
    ASSERT_NO_THROW(validate_material_ids(ids.view()));
    ASSERT_EQ(ids.values, index.cells);
    std::uint64_t compared = 0;
    for (int level = 0; level <= finest; ++level)
      for (std::uint64_t code = 0; code < std::uint64_t{1} << 3 * level; ++code) {
        const Vec3i cell = morton_decode(code);
        std::uint64_t number = 0;
        if (!find_cell_number(dag.view(), index.view(), cell, level, number)) continue;
        const double side = std::ldexp(1.0, levels - level);
        const Vec3d lo = Vec3d(cell) * side;
        std::map<std::uint32_t, double> areas;
        for (std::size_t t = 0; t < scene.mesh.triangles.size(); ++t) {
          const QuantizedTriangle q = quantized.triangle(t);
          Polygon polygon;
          for (int k = 0; k < 3; ++k) polygon.push_back(Vec3d(q[k]) * (1.0 / kSubvoxels));
          areas[scene.mesh.triangle_materials[t]] +=
              area_of(clipped(polygon, lo, lo + Vec3d{side, side, side}));
        }
        double first = 0, second = 0;
        std::uint32_t largest = 0;
        for (const auto& [id, area] : areas) {
          if (area > first) {
            second = first;
            first = area;
            largest = id;
          } else {
            second = std::max(second, area);
          }
        }
        if (second > first * 0.999 - 1e-4) continue;  // nearly equal
        ++compared;
        ASSERT_EQ(read_material(ids.view(), number), largest)
            << "level " << level << " of " << finest << ", cell " << code;
      }
    EXPECT_GT(compared, index.cells * 9 / 10);
  }
}

/// The first of two equal triangles has the larger id, or the smaller one.
TEST(FilterMaterials, OfEqualAreasTheSmallestIdCounts) {
  for (const bool is_larger_first : {false, true}) {
    MaterialMesh scene(5, 6, 7);
    const std::size_t count = scene.mesh.triangles.size();
    for (std::size_t t = 0; t < count; ++t) {
      const Triangle triangle = scene.mesh.triangles[t];
      // The second one has other corners first, so that its pieces are computed differently.
      scene.mesh.triangles.push_back({triangle[1], triangle[2], triangle[0]});
      scene.mesh.triangle_materials[t] = is_larger_first ? 5 : 2;
      scene.mesh.triangle_materials.push_back(is_larger_first ? 2 : 5);
    }
    const Svdag dag = scene.dag();
    const MaterialIds ids = scene.filter(dag.view(), 6);
    for (std::uint64_t i = 0; i < ids.values; ++i) ASSERT_EQ(read_material(ids.view(), i), 2u);
  }
}

TEST(FilterMaterials, AnyNumberOfThreadsGivesTheSameIds) {
  const MaterialMesh scene(40, 8, 300);
  const Svdag dag = scene.dag();
  const auto filter = [&](int threads) {
    return with_threads(threads, [&] { return scene.filter(dag.view(), 8); });
  };
  const MaterialIds one = filter(1), four = filter(4);
  EXPECT_GT(one.values, 3u << 16);  // several tasks
  EXPECT_EQ(one.words, four.words);
  EXPECT_EQ(one.pages, four.pages);
  EXPECT_EQ(one.groups, four.groups);
}

TEST(FilterMaterials, AMemoryLimitIsKeptOrRefused) {
  const MaterialMesh scene(40, 7, 9);
  const Svdag dag = scene.dag();
  AttributeOptions options;
  options.materials = true;
  options.finest_level = 7;
  expect_limit_is_kept_or_refused([&](MemoryBudget& budget) {
    build_attributes(scene.mesh, scene.grid, dag.view(), nullptr, options, &budget);
  });
}

TEST(MaterialColors, EveryCellHasTheColourOfItsMaterial) {
  const MaterialMesh scene(12, 6, 40);
  const Svdag dag = scene.dag();
  const MaterialIds ids = scene.filter(dag.view(), 6);
  const ValuePages colors = material_colors(ids.view());
  for (std::uint64_t i = 0; i < ids.values; ++i)
    ASSERT_EQ(read_value(colors.view(), i), material_color(read_material(ids.view(), i)));
}

TEST(MaterialColors, NearIdsHaveDifferentColours) {
  for (std::uint32_t a = 0; a < 200; ++a)
    for (std::uint32_t b = a + 1; b < a + 8; ++b) {
      const Value8 one = material_color(a), other = material_color(b);
      int apart = 0;
      for (int c = 0; c < 3; ++c) apart += std::abs(one[c] - other[c]);
      EXPECT_GT(apart, 30) << a << ", " << b;
    }
}

}  // namespace
}  // namespace voxdag
