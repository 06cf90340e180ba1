#include "voxdag/builders/attributes/filter_cells.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "support/clipped_polygon.hpp"
#include "support/memory_limit.hpp"
#include "support/with_threads.hpp"
#include "voxdag/builders/attributes/build_attributes.hpp"
#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/srgb.hpp"
#include "voxdag/stored/attributes/build_cell_index.hpp"
#include "voxdag/stored/attributes/look.hpp"

namespace voxdag {
namespace {

/// Keeps all values.
class Values : public CellValueSink {
 public:
  explicit Values(std::uint64_t cells, bool with_normals = true)
      : values(cells), times(cells), with_normals_(with_normals) {}
  bool needs_normals() const override { return with_normals_; }
  void add(std::uint64_t first, std::span<const VoxelValue> part) override {
    for (const VoxelValue& value : part) {
      values[first] = value;
      ++times[first++];
    }
  }
  std::vector<VoxelValue> values;
  std::vector<int> times;

 private:
  bool with_normals_;
};

/// A mesh of large triangles with a colour at each corner.
struct ColoredMesh {
  Mesh mesh;
  Appearance appearance;
  Grid grid;

  ColoredMesh(int triangles, int levels) {
    std::mt19937 rng(5);
    const auto unit = [&] { return static_cast<float>(rng() >> 8) / 16777216.0f; };
    const auto level = [&] { return static_cast<std::uint16_t>(rng() >> 16); };
    for (int i = 0; i < triangles; ++i) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (int k = 0; k < 3; ++k) {
        mesh.vertices.push_back({unit(), unit(), unit()});
        appearance.colors.push_back({level(), level(), level(), 65535});
      }
      mesh.triangles.push_back({first, first + 1, first + 2});
    }
    appearance.materials.resize(1);
    grid = fit_grid(mesh, levels);
  }
};

/// The mean colour of the surface in a box of the grid, by clipping every triangle to it: for
/// corner colours, the mean over a polygon is the colour at its centroid.
struct BruteMean {
  Vec3d color{};
  double area = 0;

  BruteMean(const ColoredMesh& of, Vec3d lo, Vec3d hi) {
    for (std::size_t t = 0; t < of.mesh.triangles.size(); ++t) {
      Vec3d corners[3], colors[3];
      for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = of.grid.to_grid(Vec3d(of.mesh.vertices[of.mesh.triangles[t][k]]));
        colors[k] = Vec3d(of.appearance.colors[3 * t + k].color());
      }
      const Polygon polygon = clipped(Polygon(corners, corners + 3), lo, hi);
      const Vec3d normal = cross(corners[1] - corners[0], corners[2] - corners[0]);
      for (std::size_t i = 2; i < polygon.size(); ++i) {
        const Vec3d n = cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
        const Vec3d centre = (polygon[0] + polygon[i - 1] + polygon[i]) * (1.0 / 3);
        const double b1 =
            dot(cross(centre - corners[0], corners[2] - corners[0]), normal) / dot(normal, normal);
        const double b2 =
            dot(cross(corners[1] - corners[0], centre - corners[0]), normal) / dot(normal, normal);
        const double part = length(n) / 2;
        color = color + (colors[0] * (1 - b1 - b2) + colors[1] * b1 + colors[2] * b2) * part;
        area += part;
      }
    }
  }
};

TEST(FilterCells, EveryCellHasTheMeanColourOfTheSurfaceInIt) {
  const int levels = 5;
  const ColoredMesh scene(6, levels);
  const SurfaceShading shading(scene.mesh, scene.appearance);
  const Svdag dag = build_svdag(scene.mesh, scene.grid, {}).dag;
  for (int finest = 2; finest <= levels; ++finest) {
    const CellIndex index = build_cell_index(dag.view(), finest);
    Values sink(index.cells);
    filter_cells(scene.mesh, scene.grid, dag.view(), index.view(), &shading, sink);
    std::uint64_t compared = 0;
    for (int level = 0; level <= finest; ++level)
      for (std::uint64_t code = 0; code < std::uint64_t{1} << 3 * level; ++code) {
        const Vec3i cell = morton_decode(code);
        std::uint64_t number = 0;
        if (!find_cell_number(dag.view(), index.view(), cell, level, number)) continue;
        ASSERT_EQ(sink.times[number], 1);
        const double side = std::ldexp(1.0, levels - level);
        const Vec3d lo = Vec3d(cell) * side;
        const BruteMean mean(scene, lo, lo + Vec3d{side, side, side});
        if (mean.area < 0.02) continue;  // rounding to 1/256 voxel moves the surface
        ++compared;
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(sink.values[number].color[c],
                      255 * linear_to_srgb(static_cast<float>(mean.color[c] / mean.area)), 2.5)
              << "level " << level << " of " << finest << ", cell " << code;
      }
    EXPECT_GT(compared, index.cells / 2);
  }
}

/// The transparent sheet fills whole tasks.
TEST(FilterCells, ColoursDoNotDependOnWhetherNormalsAreNeeded) {
  ColoredMesh scene(20, 6);
  for (std::size_t i = 0; i < scene.appearance.colors.size(); ++i)
    scene.appearance.normals.push_back(i % 3 == 0 ? Vec3f{0, 0, 1} : Vec3f{0, 0.6f, 0.8f});
  for (const bool has_colors : {true, false}) {
    if (!has_colors) scene.appearance.colors.clear();
    const SurfaceShading shading(scene.mesh, scene.appearance);
    const Svdag dag = build_svdag(scene.mesh, scene.grid, {}).dag;
    const CellIndex index = build_cell_index(dag.view(), 6);
    Values with(index.cells), without(index.cells, false);
    filter_cells(scene.mesh, scene.grid, dag.view(), index.view(), &shading, with);
    filter_cells(scene.mesh, scene.grid, dag.view(), index.view(), &shading, without);
    for (std::uint64_t i = 0; i < index.cells; ++i) {
      ASSERT_EQ(without.times[i], 1);
      for (int c = 0; c < 3; ++c) ASSERT_EQ(without.values[i].color[c], with.values[i].color[c]);
    }
  }
}

TEST(FilterCells, CellsWithoutVisibleSurfaceHaveTheValueOfTheNearestCellAboveThatHasSome) {
  const int levels = 9;
  Mesh mesh;
  Appearance appearance;
  const auto add_sheet = [&](float z, const Rgba16& color) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vec3f corner : {Vec3f{0, 0, z}, Vec3f{1, 0, z}, Vec3f{1, 1, z}, Vec3f{0, 1, z}})
      mesh.vertices.push_back(corner);
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
    appearance.colors.insert(appearance.colors.end(), 6, color);
  };
  add_sheet(0, {65535, 0, 0, 65535});
  add_sheet(1, {0, 65535, 0, 0});
  appearance.materials.resize(1);
  appearance.materials[0].alpha_mode = AlphaMode::kMask;
  const Grid grid = fit_grid(mesh, levels);
  const SurfaceShading shading(mesh, appearance);
  const Svdag dag = build_svdag(mesh, grid, {}).dag;
  const CellIndex index = build_cell_index(dag.view(), levels);
  ASSERT_GT(index.cells, 8u << 16);
  Values sink(index.cells);
  filter_cells(mesh, grid, dag.view(), index.view(), &shading, sink);
  for (std::uint64_t i = 0; i < index.cells; ++i) {
    ASSERT_EQ(sink.times[i], 1);
    ASSERT_EQ((Value8{sink.values[i].color[0], sink.values[i].color[1], sink.values[i].color[2]}),
              (Value8{255, 0, 0}))
        << "cell " << i;
  }
}

TEST(FilterCells, AnyNumberOfThreadsGivesTheSameAttributes) {
  const ColoredMesh scene(40, 8);
  const SurfaceShading shading(scene.mesh, scene.appearance);
  const Svdag dag = build_svdag(scene.mesh, scene.grid, {}).dag;
  AttributeOptions options;
  options.colors = options.normals = true;
  options.finest_level = 8;
  const auto build = [&](int threads) {
    return with_threads(threads, [&] {
      return build_attributes(scene.mesh, scene.grid, dag.view(), &shading, options);
    });
  };
  const DagAttributes one = build(1), four = build(4);
  EXPECT_GT(one.index.cells, 3u << 16);  // several tasks
  EXPECT_EQ(one.index, four.index);
  EXPECT_EQ(one.colors.words, four.colors.words);
  EXPECT_EQ(one.colors.pages, four.colors.pages);
  EXPECT_EQ(one.normals.words, four.normals.words);
}

TEST(FilterCells, AMemoryLimitIsKeptOrRefused) {
  const ColoredMesh scene(40, 7);
  const SurfaceShading shading(scene.mesh, scene.appearance);
  const Svdag dag = build_svdag(scene.mesh, scene.grid, {}).dag;
  AttributeOptions options;
  options.colors = true;
  options.finest_level = 7;
  expect_limit_is_kept_or_refused([&](MemoryBudget& budget) {
    build_attributes(scene.mesh, scene.grid, dag.view(), &shading, options, &budget);
  });
}

TEST(BuildAttributes, TheFinestLevelIsTheLastThatIsExpectedToFit) {
  SvdagCounts counts;
  counts.svo_nodes_per_level = {1, 8, 64, 512};
  counts.voxels = 4096;
  const auto finest = [&](bool colors, bool normals, bool materials, std::uint64_t bytes) {
    AttributeOptions options;
    options.colors = colors;
    options.normals = normals;
    options.materials = materials;
    return finest_level_within(counts, options, bytes);
  };
  EXPECT_EQ(finest(true, false, false, 5000), 4);  // 4681 cells
  EXPECT_EQ(finest(true, true, false, 5000), 3);   // 585 cells
  EXPECT_EQ(finest(false, true, false, 600), 3);
  EXPECT_EQ(finest(false, false, true, 600), 4);
  EXPECT_EQ(finest(false, false, true, 500), 3);
  EXPECT_EQ(finest(true, true, true, 0), 0);
}

TEST(BuildAttributes, NormalsAreWithinTheirBound) {
  const ColoredMesh scene(12, 6);
  const SurfaceShading shading(scene.mesh, scene.appearance);
  const Svdag dag = build_svdag(scene.mesh, scene.grid, {}).dag;
  const CellIndex index = build_cell_index(dag.view(), 6);
  Values exact(index.cells);
  filter_cells(scene.mesh, scene.grid, dag.view(), index.view(), &shading, exact);
  AttributeOptions options;
  options.normals = true;
  options.finest_level = 6;
  for (const double degrees : {kMinNormalBound, 2.0, 10.0}) {
    options.normal_bound_degrees = degrees;
    const DagAttributes attributes =
        build_attributes(scene.mesh, scene.grid, dag.view(), &shading, options);
    for (std::uint64_t i = 0; i < index.cells; ++i) {
      const Vec3f stored = unpack_normal(read_value(attributes.normals.view(), i));
      const double chord = length(Vec3d(stored - exact.values[i].normal));
      ASSERT_LE(2 * std::asin(chord / 2) * 180 / M_PI, degrees + 0.03);
    }
  }
}

}  // namespace
}  // namespace voxdag
