// Compares the channels metallic and roughness of a build with means over clipped triangles.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/clipped_polygon.hpp"
#include "support/textured_square.hpp"
#include "support/with_threads.hpp"
#include "voxdag/builders/attributes/build_attributes.hpp"
#include "voxdag/builders/attributes/inside_attributes.hpp"
#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/mesh/surface/material_textures.hpp"
#include "voxdag/mesh/surface/surface_shading.hpp"
#include "voxdag/stored/attributes/look.hpp"

namespace voxdag {
namespace {

AttributeOptions both_channels(int finest) {
  AttributeOptions options;
  options.metallic = options.roughness = true;
  options.finest_level = finest;
  return options;
}

DagAttributes build_both(const Mesh& mesh, const Appearance& appearance, const Grid& grid,
                         const Svdag& dag, int finest) {
  const SurfaceShading shading(mesh, appearance, nullptr, {}, true);
  return build_attributes(mesh, grid, dag.view(), &shading, both_channels(finest));
}

/// Calls use(lo, hi, metallic, roughness) for each cell of `attributes`, with its box in voxels.
template <class Use>
void for_each_pair(const Svdag& dag, const DagAttributes& attributes, const Use& use) {
  const ChannelsView channels = attributes.view().channels;
  ASSERT_EQ(channels.count(), 2u);
  EXPECT_EQ(spec_of(channels[0]), (ChannelSpec{"metallic", ChannelKind::kU8, 0}));
  EXPECT_EQ(spec_of(channels[1]), (ChannelSpec{"roughness", ChannelKind::kU8, 0}));
  for (int level = 0; level <= attributes.index.finest_level; ++level)
    for (std::uint64_t code = 0; code < std::uint64_t{1} << 3 * level; ++code) {
      const Vec3i cell = morton_decode(code);
      std::uint64_t number = 0;
      if (!find_cell_number(dag.view(), attributes.index.view(), cell, level, number)) continue;
      const double side = std::ldexp(1.0, dag.levels - level);
      const Vec3d lo = Vec3d(cell) * side;
      use(lo, lo + Vec3d{side, side, side}, channels[0].read(number), channels[1].read(number));
    }
}

TEST(MetallicRoughness, EveryCellHasTheMeanOfTheSurfaceInIt) {
  std::mt19937 rng(11);
  const auto unit = [&] { return static_cast<float>(rng() >> 8) / 16777216.0f; };
  Mesh mesh;
  Appearance appearance;
  for (std::uint32_t i = 0; i < 8; ++i) {
    for (int k = 0; k < 3; ++k) {
      // Whole and half voxels: quantised without rounding.
      const auto place = [&] { return static_cast<float>(rng() % 65) / 2; };
      mesh.vertices.push_back({place(), place(), place()});
    }
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    mesh.triangle_materials.push_back(i);
    mesh.materials.push_back("m");
    appearance.materials.emplace_back().metallic_roughness = {unit(), unit()};
  }
  Grid grid;
  grid.levels = 5;
  const Svdag dag = build_svdag(mesh, grid, {}).dag;
  for (const int finest : {3, 5}) {
    const DagAttributes attributes = build_both(mesh, appearance, grid, dag, finest);
    int compared = 0;
    for_each_pair(dag, attributes, [&](Vec3d lo, Vec3d hi, double metallic, double roughness) {
      double area = 0, metallic_sum = 0, roughness_sum = 0;
      for (std::size_t t = 0; t < 8; ++t) {
        Polygon corners;
        for (std::size_t k = 0; k < 3; ++k) corners.push_back(Vec3d(mesh.vertices[3 * t + k]));
        const double part = area_of(clipped(corners, lo, hi));
        const MetallicRoughness of = appearance.materials[t].metallic_roughness;
        area += part;
        metallic_sum += part * static_cast<double>(of.metallic);
        roughness_sum += part * static_cast<double>(of.roughness);
      }
      // Triangles that only touch the cell have a weight of 1e-6.
      if (area < 0.01) return;
      ++compared;
      // The nearest of 256 numbers; 0.01 for sums in floats where two are about equally near.
      EXPECT_NEAR(metallic, 255 * metallic_sum / area, 0.51);
      EXPECT_NEAR(roughness, 255 * roughness_sum / area, 0.51);
    });
    EXPECT_GT(compared, finest == 3 ? 100 : 1000);
  }
}

/// A texture whose blue and green are ramps, over 16 voxels of 16 texels each.
struct Ramps : Square {
  Grid grid;
  Svdag dag;

  explicit Ramps(bool is_noise = false) {
    std::vector<std::uint16_t> samples;
    std::mt19937 rng(3);
    for (int y = 0; y < 256; ++y)
      for (int x = 0; x < 256; ++x)
        for (const int value : {255, 255 - y, x})
          samples.push_back(static_cast<std::uint16_t>(is_noise ? rng() >> 24 : value));
    material().metallic_map = material().roughness_map = texture("ramps.png", 256, 256, 3, samples);
    material().map_factors = {0.5f, 1};
    grid.levels = 4;
    grid.voxel_size = 1.0 / 16;
    grid.quantization_scale = 256 * 16;
    dag = build_svdag(mesh, grid, {}).dag;
  }
};

TEST(MetallicRoughness, TexturesAreAveragedInLinearUnitsOverTheVoxel) {
  const Ramps scene;
  const DagAttributes attributes =
      build_both(scene.mesh, scene.appearance, scene.grid, scene.dag, 4);
  int compared = 0;
  for_each_pair(scene.dag, attributes, [&](Vec3d lo, Vec3d hi, double metallic, double roughness) {
    if (hi.x - lo.x > 1 || lo.x < 1 || lo.y < 1 || hi.x > 15 || hi.y > 15) return;
    ++compared;
    // Texel i has the number i: the mean of 16 texels from 16 n on is 16 n + 7.5. The image's upper
    // row is at y = 1.
    EXPECT_NEAR(metallic, (16 * lo.x + 7.5) / 2, 0.6);
    EXPECT_NEAR(roughness, 255 - (16 * (15 - lo.y) + 7.5), 0.6);
  });
  EXPECT_EQ(compared, 14 * 14);
}

TEST(MetallicRoughness, TheMeanOfAPolygonIsThatOfTheTexelsInIt) {
  Ramps scene(true);
  const DagAttributes channels = build_both(scene.mesh, scene.appearance, scene.grid, scene.dag, 4);
  const SurfaceShading shading(scene.mesh, scene.appearance, nullptr, {}, true);
  const std::vector<Vec2f> polygon = {{0.25f, 0.25f}, {0.375f, 0.25f}, {0.25f, 0.5f}};
  const MetallicRoughness mean = shading.mean(0, polygon).metallic_roughness;
  // The brute mean over texels whose centres lie in the polygon.
  const DecodedImage image = decode_texture_image(scene.appearance.images[0], {});
  double sum = 0;
  int texels = 0;
  for (int y = 0; y < 256; ++y)
    for (int x = 0; x < 256; ++x) {
      const double u = (x + 0.5) / 256, v = 1 - (y + 0.5) / 256;  // triangle 0: (u - v, v)
      const double b1 = u - v, b2 = v;
      const double s = (b1 - 0.25) / 0.125, t = (b2 - 0.25) / 0.25;
      if (s < 0 || t < 0 || s + t > 1) continue;
      sum += image.pixel(x, y)[1] / 65535.0;
      ++texels;
    }
  EXPECT_GT(texels, 500);
  EXPECT_NEAR(static_cast<double>(mean.roughness), sum / texels, 0.02);
  EXPECT_EQ(shading.mean(0, polygon, false).metallic_roughness, mean);
  EXPECT_NEAR(channels.view().channels[1].read(0), 127.5, 2);
}

TEST(MetallicRoughness, AnImageThatCannotBeReadIsOneWarning) {
  Ramps scene;
  scene.material().metallic_roughness = {0.25f, 0.75f};
  scene.appearance.images[0].path = scene.directory.path() / "none.png";
  std::vector<std::string> warnings;
  const SurfaceShading shading(scene.mesh, scene.appearance, &warnings, {}, true);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("none.png: cannot open"), std::string::npos) << warnings[0];
  EXPECT_TRUE(warnings[0].ends_with(": the material's metallic and roughness replace the texture"))
      << warnings[0];
  EXPECT_EQ(shading.mean(0, {}, false).metallic_roughness, (MetallicRoughness{0.25f, 0.75f}));
  warnings.clear();
  const SurfaceShading without(scene.mesh, scene.appearance, &warnings);
  EXPECT_TRUE(warnings.empty());  // The image is not wanted.
  EXPECT_EQ(without.mean(0, {}, false).metallic_roughness, MetallicRoughness{});
}

TEST(MetallicRoughness, AnyNumberOfThreadsGivesTheSameChannels) {
  const Ramps scene(true);
  const auto build = [&](int threads) {
    return with_threads(threads, [&] {
      return build_both(scene.mesh, scene.appearance, scene.grid, scene.dag, 4).channels.words;
    });
  };
  EXPECT_EQ(build(1), build(4));
}

TEST(MetallicRoughness, TheInsideOfASolidHasTheNumbersOfTheNearestSurface) {
  const Ramps scene;
  const DagAttributes surface = build_both(scene.mesh, scene.appearance, scene.grid, scene.dag, 4);
  Mesh thick = scene.mesh;  // Two more voxels above the square.
  for (const float z : {0.1f, 0.16f}) {
    const auto first = static_cast<std::uint32_t>(thick.vertices.size());
    for (std::size_t i = 0; i < 4; ++i)
      thick.vertices.push_back({scene.mesh.vertices[i].x, scene.mesh.vertices[i].y, z});
    thick.triangles.push_back({first, first + 1, first + 2});
    thick.triangles.push_back({first, first + 2, first + 3});
  }
  const Svdag solid = build_svdag(thick, scene.grid, {}).dag;
  const DagAttributes filled =
      inside_attributes({scene.dag.view(), surface.view()}, solid.view(), both_channels(4), {});
  const ChannelsView channels = filled.view().channels;
  ASSERT_EQ(channels.count(), 2u);
  for (int x = 0; x < 16; ++x)
    for (int z = 0; z < 3; ++z) {
      std::uint64_t number = 0, below = 0;
      ASSERT_TRUE(find_cell_number(solid.view(), filled.index.view(), {x, 5, z}, 4, number));
      ASSERT_TRUE(find_cell_number(scene.dag.view(), surface.index.view(), {x, 5, 0}, 4, below));
      for (std::size_t c = 0; c < 2; ++c)
        EXPECT_EQ(channels[c].read(number), surface.view().channels[c].read(below));
    }
}

}  // namespace
}  // namespace voxdag
