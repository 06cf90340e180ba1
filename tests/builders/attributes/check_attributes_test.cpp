#include "voxdag/builders/attributes/check_attributes.hpp"

#include <gtest/gtest.h>

#include <random>

#include "voxdag/builders/attributes/build_attributes.hpp"
#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/stored/attributes/encode_material_ids.hpp"

namespace voxdag {
namespace {

/// Random triangles with colours and materials, their DAG and its attributes.
struct CheckedScene {
  CheckedScene() {
    std::mt19937 rng(9);
    const auto unit = [&] { return static_cast<float>(rng() >> 8) / 16777216.0f; };
    const auto level = [&] { return static_cast<std::uint16_t>(rng() >> 16); };
    for (int i = 0; i < 12; ++i) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (int k = 0; k < 3; ++k) {
        mesh.vertices.push_back({unit(), unit(), unit()});
        appearance.colors.push_back({level(), level(), level(), 65535});
      }
      mesh.triangles.push_back({first, first + 1, first + 2});
      mesh.triangle_materials.push_back(static_cast<std::uint32_t>(rng() % 4));
    }
    // A repeated triangle counts once in colours and twice in materials.
    mesh.triangles.push_back(mesh.triangles[3]);
    mesh.triangle_materials.push_back(mesh.triangle_materials[3]);
    for (std::size_t k = 0; k < 3; ++k) {
      const Rgba16 color = appearance.colors[9 + k];
      appearance.colors.push_back(color);
    }
    appearance.materials.resize(4);
    mesh.materials.resize(4);
    grid = fit_grid(mesh, 6);
    dag = build_svdag(mesh, grid, {}).dag;
    AttributeOptions options;
    options.colors = options.normals = options.materials = true;
    options.finest_level = 6;
    const SurfaceShading shading(mesh, appearance);
    attributes = build_attributes(mesh, grid, dag.view(), &shading, options);
  }
  AttributeCheck check(std::uint64_t samples = 1'000'000) const {
    const SurfaceShading shading(mesh, appearance);
    return check_attributes(mesh, grid, {dag.view(), attributes.view()}, shading, samples, 1);
  }

  Mesh mesh;
  Appearance appearance;
  Grid grid;
  Svdag dag;
  DagAttributes attributes;
};

TEST(CheckAttributes, WhatTheBuilderStoresIsWithinTheBounds) {
  const CheckedScene scene;
  const AttributeCheck check = scene.check();
  EXPECT_EQ(check.colors.cells, scene.attributes.index.cells);
  EXPECT_EQ(check.materials.cells, scene.attributes.index.cells);
  EXPECT_GT(check.normals.cells, scene.attributes.index.cells / 2);
  EXPECT_LE(check.colors.largest_error, AttributeOptions{}.color_bound + kColorTolerance);
  EXPECT_GT(check.colors.largest_error, 0.02) << "the encoder uses its bound";
  EXPECT_LE(check.normals.largest_error,
            AttributeOptions{}.normal_bound_degrees + kNormalTolerance);
  EXPECT_LE(check.materials.largest_error, kMaterialTolerance);
}

TEST(CheckAttributes, AFlippedBitOfAColourIsFound) {
  CheckedScene scene;
  // The highest bit of the red of the first end, after the header of the first block.
  const PagePrecision precision = scene.attributes.colors.precision;
  const int bit = precision.header_bits() + precision.channel_bits(0) - 1;
  scene.attributes.colors.words[0] ^= std::uint64_t{1} << bit;
  const AttributeCheck check = scene.check();
  EXPECT_GT(check.colors.largest_error, 0.1);
  EXPECT_LE(check.normals.largest_error,
            AttributeOptions{}.normal_bound_degrees + kNormalTolerance);
}

TEST(CheckAttributes, AWrongMaterialIsFoundAtItsCell) {
  CheckedScene scene;
  const CellIndexView index = scene.attributes.index.view();
  const Vec3i cell = [&] {
    for (std::uint64_t code = 0;; ++code)
      if (std::uint64_t number = 0;
          find_cell_number(scene.dag.view(), index, morton_decode(code), 6, number))
        return morton_decode(code);
  }();
  std::uint64_t wrong = 0;
  ASSERT_TRUE(find_cell_number(scene.dag.view(), index, cell, 6, wrong));
  MaterialEncoder encoder(5);
  for (std::uint64_t i = 0; i < index.cells; ++i)
    encoder.add(i == wrong ? 4 : read_material(scene.attributes.materials.view(), i), 1);
  scene.attributes.materials = encoder.finish();
  const AttributeCheck check = scene.check();
  EXPECT_EQ(check.materials.largest_error, 1);
  EXPECT_EQ(check.materials.worst, cell);
  EXPECT_EQ(check.materials.worst_level, 6);
}

TEST(CheckAttributes, SomeSamplesAreSomeCells) {
  const CheckedScene scene;
  const AttributeCheck check = scene.check(100);
  EXPECT_GT(check.colors.cells, 90u);
  EXPECT_LE(check.colors.cells, 100u);
  EXPECT_EQ(scene.check(0).colors.cells, 0u);
}

}  // namespace
}  // namespace voxdag
