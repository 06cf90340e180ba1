// Splats as voxels against sums over all voxels and all splats in double, with std::exp.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "raw_splats.hpp"
#include "support/brute_svdag.hpp"
#include "support/error_of.hpp"
#include "support/with_threads.hpp"
#include "voxdag/formats/imports/colors/linear_color.hpp"
#include "voxdag/formats/imports/import_voxels.hpp"
#include "voxdag/formats/imports/moved_source.hpp"
#include "voxdag/stored/attributes/cell_index_lookup.hpp"
#include "voxdag/stored/attributes/page_reader.hpp"
#include "voxdag/stored/svdag/for_each_voxel.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"

namespace voxdag {
namespace {

/// The sums of a voxel, computed from the definition.
struct BruteSum {
  double extinction = 0;
  std::array<double, 3> color{};  ///< Weighted, in linear light.
};

/// Returns the sums of all voxels of a grid; x runs fastest.
std::vector<BruteSum> brute_sums(const std::vector<RawSplat>& splats, const Grid& grid,
                                 double min_scale) {
  const auto side = static_cast<int>(grid.resolution());
  std::vector<BruteSum> sums(static_cast<std::size_t>(side * side * side));
  for (const RawSplat& s : splats) {
    double w = s.rotation[0], x = s.rotation[1], y = s.rotation[2], z = s.rotation[3];
    const double length = std::sqrt(w * w + x * x + y * y + z * z);
    w /= length, x /= length, y /= length, z /= length;
    // The columns of the rotation are the splat's axes.
    const double turn[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
                               {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
                               {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}};
    double scale[3];
    for (std::size_t k = 0; k < 3; ++k)
      scale[k] = std::max<double>(std::exp(double{s.log_scale[k]}), min_scale);
    const double alpha = std::min(1 / (1 + std::exp(-double{s.opacity})), 0.99);
    // A cube that holds the splat.
    const double reach = 3 * std::max({scale[0], scale[1], scale[2]}) / grid.voxel_size + 1;
    int lo[3], hi[3];
    for (int axis = 0; axis < 3; ++axis) {
      const double at = (s.center[axis] - grid.origin[axis]) / grid.voxel_size;
      lo[axis] = static_cast<int>(std::clamp(at - reach, 0.0, static_cast<double>(side)));
      hi[axis] = static_cast<int>(std::clamp(at + reach + 1, 0.0, static_cast<double>(side)));
    }
    for (int k = lo[2]; k < hi[2]; ++k)
      for (int j = lo[1]; j < hi[1]; ++j)
        for (int i = lo[0]; i < hi[0]; ++i) {
          const Vec3d middle = grid.to_world(Vec3d{i + 0.5, j + 0.5, k + 0.5});
          const double p[3] = {middle.x - s.center[0], middle.y - s.center[1],
                               middle.z - s.center[2]};
          double squared = 0;
          for (std::size_t a = 0; a < 3; ++a) {
            const double u = (turn[0][a] * p[0] + turn[1][a] * p[1] + turn[2][a] * p[2]) / scale[a];
            squared += u * u;
          }
          if (squared > 9) continue;
          const double term = -std::log1p(-alpha) * std::exp(-squared / 2);
          BruteSum& sum = sums[static_cast<std::size_t>((k * side + j) * side + i)];
          sum.extinction += term;
          for (std::size_t c = 0; c < 3; ++c)
            sum.color[c] +=
                term * linear_of(color_byte(0.5 + 0.28209479177387814 * double{s.color[c]}));
        }
  }
  return sums;
}

/// Expects the voxels of the definition. A sum that is nearer to the threshold than `slack` may be
/// on either side; at most `unsure` are.
void expect_brute_voxels(const ImportResult& result, const std::vector<RawSplat>& splats,
                         double slack = 1e-7, int unsure = 0) {
  const double least = -std::log1p(-*result.splats.opacity);
  const std::vector<BruteSum> sums = brute_sums(splats, result.grid, *result.splats.min_scale);
  const auto side = static_cast<int>(result.grid.resolution());
  std::vector<bool> is_set(sums.size());
  for_each_voxel(result.dag.view(), whole_grid(result.grid.levels), [&](Vec3i v) {
    is_set[static_cast<std::size_t>((v.z * side + v.y) * side + v.x)] = true;
  });
  int different = 0, close = 0;
  std::size_t count = 0;
  for (std::size_t at = 0; at < sums.size(); ++at) {
    const bool is_expected = sums[at].extinction >= least;
    const bool is_close = std::abs(sums[at].extinction - least) < slack;
    count += is_expected ? 1 : 0;
    close += is_close ? 1 : 0;
    different += !is_close && is_set[at] != is_expected ? 1 : 0;
  }
  EXPECT_GT(count, 0u);
  EXPECT_EQ(different, 0);
  EXPECT_LE(close, unsure);
}

TEST_F(SplatsTest, VoxelsAreThoseWhoseSumReachesTheOpacity) {
  for (const double opacity : {0.1, 0.5, 0.97})
    for (const int resolution : {5, 37, 64}) {
      const std::vector<RawSplat> splats = random_splats(60, 10, 1.0, 7);
      ImportOptions with = options();
      with.resolution = resolution;
      with.splats.opacity = opacity;
      with.splats.max_scale = 100;
      const ImportResult result = import(ply_of(splats), with);
      EXPECT_EQ(result.read, 60u);
      EXPECT_EQ(result.grid.voxel_size / 2, result.splats.min_scale);
      expect_brute_voxels(result, splats);
    }
}

TEST_F(SplatsTest, TilesAndBricksLeaveNoSeams) {
  // Tiles have 128 voxels a side. The window cuts splats off.
  const std::vector<RawSplat> splats = random_splats(200, 10, 0.25, 8);
  ImportOptions with = options();
  with.voxel_size = 0.03;
  with.bounds = {{2, 2, 2}, {2 + 0.03 * 200, 4, 4}};
  with.splats = {0.3, 0.005, 10.0};
  const ImportResult result = import(ply_of(splats), with);
  ASSERT_EQ(result.grid.levels, 8);
  EXPECT_GT(result.outside, 0u);
  expect_brute_voxels(result, splats);
}

TEST_F(SplatsTest, TheOrderAndTheThreadsChangeNothing) {
  std::vector<RawSplat> splats = random_splats(60'000, 10, 0.1, 9);
  ImportOptions with = options();
  with.resolution = 140;
  with.splats.max_scale = 10;
  const ImportResult first = import(ply_of(splats), with);
  EXPECT_GT(first.dag.leaf_blocks.size(), 100u);
  std::shuffle(splats.begin(), splats.end(), std::mt19937(1));
  for (const std::size_t threads : {std::size_t{1}, std::size_t{5}}) {
    MemoryBudget budget(std::uint64_t{400} << 20);
    const ImportResult again = with_threads(
        threads, [&] { return import_voxels(*open(ply_of(splats)), with, {&budget}); });
    EXPECT_EQ(again.dag, first.dag) << threads;
    EXPECT_EQ(again.grid, first.grid);
    PageReader colors(again.attributes.colors.view()), as_before(first.attributes.colors.view());
    ASSERT_EQ(again.attributes.index, first.attributes.index);
    for (std::uint64_t i = 0; i < first.attributes.index.cells; ++i)
      ASSERT_EQ(colors.value(i), as_before.value(i));
  }
}

TEST_F(SplatsTest, ATileWithManySplatsIsSummedInParts) {
  // More than two batches of 65,536 splats in each of the tiles.
  const std::vector<RawSplat> few = random_splats(300, 10, 0.3, 10);
  std::vector<RawSplat> many;
  for (int i = 0; i < 500; ++i)
    for (RawSplat splat : few) {
      // So many splats of an extinction of 1/500 are as one.
      const double extinction = std::min(std::log1p(std::exp(double{splat.opacity})), 4.6) / 500;
      splat.opacity = static_cast<float>(std::log(std::expm1(extinction)));
      many.push_back(splat);
    }
  ImportOptions with = options();
  with.voxel_size = 0.1;
  with.bounds = {{-1, -1, -1}, {11, 11, 11}};
  with.splats = {0.4, 0.05, 10.0};
  const ImportResult result = import(ply_of(many), with);
  EXPECT_EQ(result.read, 150'000u);
  // Opacities are rounded to floats, and terms to 2^-32.
  expect_brute_voxels(result, few, 1e-5, 20);
}

TEST_F(SplatsTest, AVoxelHasTheMeanColourOfItsSplats) {
  const std::vector<RawSplat> splats = random_splats(50, 10, 1.5, 11);
  ImportOptions with = options();
  with.resolution = 32;
  with.splats.max_scale = 100;
  const ImportResult result = import(ply_of(splats), with);
  const std::vector<BruteSum> sums = brute_sums(splats, result.grid, *result.splats.min_scale);
  PageReader colors(result.attributes.colors.view());
  for_each_voxel(result.dag.view(), whole_grid(5), [&](Vec3i voxel) {
    std::uint64_t number = 0;
    ASSERT_TRUE(
        find_cell_number(result.dag.view(), result.attributes.index.view(), voxel, 5, number));
    const BruteSum& sum = sums[static_cast<std::size_t>((voxel.z * 32 + voxel.y) * 32 + voxel.x)];
    const Value8 stored = colors.value(number);
    const std::uint8_t channels[] = {stored.x, stored.y, stored.z};
    for (std::size_t c = 0; c < 3; ++c) {
      const double mean = sum.color[c] / sum.extinction / 65535;
      // Weights have 20 bits behind the point.
      EXPECT_NEAR(channels[c], 255 * linear_to_srgb(static_cast<float>(mean)), 0.6);
    }
  });
}

TEST_F(SplatsTest, PackedSplatsAreRead) {
  std::mt19937 rng(16);
  for (const bool has_chunk_colors : {false, true}) {
    constexpr int kSplats = 300;
    std::vector<std::array<float, 18>> chunks;
    for (int i = 0; i < 2; ++i)
      chunks.push_back({0, 0, 0, 2047 / 256.0f, 1023 / 128.0f, 2047 / 256.0f, -3, -2, -3, 0, 0.5f,
                        -1, 0.26f, 0.01f, 0.02f, 0.75f, 1.49f, 0.53f});
    chunks[1][0] = 1;
    std::string bytes, rows;
    std::vector<RawSplat> splats;
    for (std::size_t i = 0; i < kSplats; ++i) {
      const std::array<float, 18>& chunk = chunks[i / 256];
      const std::uint32_t words[] = {
          static_cast<std::uint32_t>(rng()), static_cast<std::uint32_t>(rng()),
          static_cast<std::uint32_t>(rng()), static_cast<std::uint32_t>(rng())};
      rows.append(reinterpret_cast<const char*>(words), sizeof words);
      const auto mix = [&](std::size_t k, double t) {
        return double{chunk[k]} * (1 - t) + double{chunk[k + 3]} * t;
      };
      const double place[] = {(words[0] >> 21) / 2047.0, (words[0] >> 11 & 1023) / 1023.0,
                              (words[0] & 2047) / 2047.0};
      const double scale[] = {(words[2] >> 21) / 2047.0, (words[2] >> 11 & 1023) / 1023.0,
                              (words[2] & 2047) / 2047.0};
      RawSplat splat{};
      for (std::size_t k = 0; k < 3; ++k) {
        splat.center[k] = static_cast<float>(mix(k, place[k]));
        splat.log_scale[k] = static_cast<float>(mix(6 + k, scale[k]));
        const double color = (words[3] >> (24 - 8 * k) & 255) / 255.0;
        const double mixed = has_chunk_colors ? mix(12 + k, color) : color;
        splat.color[k] = static_cast<float>((mixed - 0.5) / 0.28209479177387814);
      }
      const double parts[] = {(words[1] >> 20 & 1023) / 1023.0, (words[1] >> 10 & 1023) / 1023.0,
                              (words[1] & 1023) / 1023.0};
      double left = 1;
      for (std::size_t k = 0, next = 0; k < 4; ++k) {
        if (k == words[1] >> 30) continue;
        const double part = (parts[next++] - 0.5) / (std::sqrt(2.0) / 2);
        splat.rotation[k] = static_cast<float>(part);
        left -= part * part;
      }
      splat.rotation[words[1] >> 30] = static_cast<float>(std::sqrt(std::max(left, 0.0)));
      const double alpha = (words[3] & 255) / 255.0;
      splat.opacity = static_cast<float>(std::log(alpha) - std::log1p(-alpha));
      splats.push_back(splat);
    }
    bytes = "ply\nformat binary_little_endian 1.0\nelement chunk 2\n";
    for (const char* name :
         {"min_x", "min_y", "min_z", "max_x", "max_y", "max_z", "min_scale_x", "min_scale_y",
          "min_scale_z", "max_scale_x", "max_scale_y", "max_scale_z"})
      bytes += std::string("property float ") + name + "\n";
    if (has_chunk_colors)
      for (const char* name : {"min_r", "min_g", "min_b", "max_r", "max_g", "max_b"})
        bytes += std::string("property float ") + name + "\n";
    bytes += "element vertex 300\n";
    for (const char* name : {"packed_position", "packed_rotation", "packed_scale", "packed_color"})
      bytes += std::string("property uint ") + name + "\n";
    bytes += "element sh 300\nproperty uchar f_rest_0\nend_header\n";
    for (const std::array<float, 18>& chunk : chunks)
      bytes.append(reinterpret_cast<const char*>(chunk.data()), has_chunk_colors ? 72 : 48);
    bytes += rows + std::string(kSplats, '\0');
    ImportOptions with = options();
    with.resolution = 32;
    with.bounds = {{0, 0, 0}, {8, 8, 8}};
    with.splats = {0.9, 0.1, 5.0};
    const ImportResult packed = import(bytes, with);
    EXPECT_EQ(packed.read, 300u);
    // Centres are rounded to floats in the other file.
    expect_brute_voxels(packed, splats, 1e-5, 3);
    EXPECT_FALSE(packed.attributes.colors.view().is_empty());
    std::vector<Rgb8> colors, expected;
    open(bytes)->visit_all([&](const VoxelBatch& batch) {
      colors.insert(colors.end(), batch.colors.begin(), batch.colors.end());
    });
    open(ply_of(splats))->visit_all([&](const VoxelBatch& batch) {
      expected.insert(expected.end(), batch.colors.begin(), batch.colors.end());
    });
    EXPECT_EQ(colors, expected);
    for (std::size_t size = 0; size < bytes.size() - kSplats; size += 97)
      EXPECT_ANY_THROW(import(bytes.substr(0, size), with)) << size;
  }
}

TEST_F(SplatsTest, MovedSplatsAreThoseOfTheMovedScene) {
  const std::vector<RawSplat> splats = random_splats(60, 10, 1.5, 13);
  ImportOptions with = options();
  with.bounds = {{0, 0, 0}, {32, 32, 32}};
  with.resolution = 32;
  with.splats = {0.2, 0.5, 10.0};
  // A half turn about x, then twice the size, into the grid.
  TransformRequest request;
  request.rotate = "x:180";
  request.scale = 2;
  request.translate = {6, 26, 26};
  const ImportResult moved =
      import_voxels(*moved_source(open(ply_of(splats)), InputTransform(request, {})), with);
  ImportOptions unmoved = with;
  unmoved.bounds = {{-3, -3, -3}, {13, 13, 13}};
  unmoved.splats = {0.2, 0.25, 10.0};
  const ImportResult still = import(ply_of(splats), unmoved);
  std::vector<Vec3i> turned;
  for_each_voxel(still.dag.view(), whole_grid(5), [&](Vec3i v) {
    turned.push_back({v.x, 31 - v.y, 31 - v.z});
  });
  EXPECT_GT(turned.size(), 500u);
  EXPECT_EQ(moved.dag, brute_svdag(5, turned));
  // By other angles, too: turning back and forth changes nothing but roundings.
  request = {};
  request.rotate = "x:30,y:50";
  TransformRequest back;
  back.rotate = "y:-50,x:-30";
  const ImportResult again =
      import_voxels(*moved_source(moved_source(open(ply_of(splats)), InputTransform(request, {})),
                                  InputTransform(back, {})),
                    unmoved);
  EXPECT_NEAR(static_cast<double>(count_svdag(again.dag.view()).voxels),
              static_cast<double>(turned.size()), 2);
}

TEST_F(SplatsTest, BrokenAndHugeSplatsAreCountedAndLeftOut) {
  std::vector<RawSplat> splats = random_splats(20, 10, 0.1, 14);
  ImportOptions with = options();
  with.resolution = 32;
  const ImportResult good = import(ply_of(splats), with);
  // 1/64 of 10, rounded down to a power of two.
  EXPECT_EQ(good.splats.max_scale, 0.125);
  const RawSplat one = splats.front();
  const auto add = [&](const auto& change) {
    splats.push_back(one);
    change(splats.back());
  };
  add([](RawSplat& s) { s.center[1] = NAN; });
  add([](RawSplat& s) { s.center[2] = INFINITY; });
  add([](RawSplat& s) { s.log_scale[0] = NAN; });
  add([](RawSplat& s) { s.log_scale[0] = 1e30f; });
  add([](RawSplat& s) { s.opacity = NAN; });
  add([](RawSplat& s) { s.rotation = {0, 0, 0, 0}; });
  add([](RawSplat& s) { s.rotation[3] = INFINITY; });
  add([](RawSplat& s) { s.log_scale[2] = 5; });
  add([](RawSplat& s) { s.log_scale[2] = std::log(0.126f); });
  const ImportResult result = import(ply_of(splats), with);
  EXPECT_EQ(result.not_finite, 7u);
  EXPECT_EQ(result.too_large, 2u);
  EXPECT_EQ(result.grid, good.grid);
  EXPECT_EQ(result.dag, good.dag);
  EXPECT_NE(error_of([&] { import(ply_of({splats[20]}), with); }).find("not finite"),
            std::string::npos);
  EXPECT_NE(error_of([&] { import(ply_of({}), with); }).find("has no splats"), std::string::npos);
  with.splats.max_scale = 1e-9;
  EXPECT_NE(error_of([&] { import(ply_of(splats), with); }).find("too large"), std::string::npos);
  // A flat splat without opacity sets nothing, and one without thickness is as thick as min_scale.
  RawSplat flat = one;
  flat.log_scale = {-2, -2, -INFINITY};
  flat.opacity = 3;
  with.splats = {0.1, {}, 10.0};
  EXPECT_FALSE(import(ply_of({flat}), with).dag.leaf_blocks.empty());
  flat.opacity = -INFINITY;
  EXPECT_TRUE(import(ply_of({flat}), with).dag.leaf_blocks.empty());
}

TEST_F(SplatsTest, OthersThanSplatsStayPoints) {
  const std::vector<RawSplat> splats = random_splats(20, 10, 0.1, 15);
  write_text(dir_ / "s.ply", ply_of(splats));
  const auto points =
      open_voxel_source(dir_ / "s.ply", {.threshold = {}, .splats_are_points = true});
  EXPECT_FALSE(points->has_splats());
  ImportOptions with = options();
  with.resolution = 32;
  EXPECT_EQ(count_svdag(import_voxels(*points, with).dag.view()).voxels, 20u);
}

}  // namespace
}  // namespace voxdag
