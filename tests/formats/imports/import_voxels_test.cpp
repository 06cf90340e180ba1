// Imports against sets of voxels that are computed one by one, and damaged files of every format.
#include "voxdag/formats/imports/import_voxels.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

#include "support/brute_svdag.hpp"
#include "support/error_of.hpp"
#include "support/temp_dir.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/file/npy.hpp"

namespace voxdag {
namespace {

class Import : public testing::Test {
 protected:
  std::string path(const std::string& name) const { return dir_ / name; }
  ImportResult import(const std::string& name, ImportOptions options = {}) const {
    options.folder = dir_.path();
    return import_voxels(*open_voxel_source(path(name)), options);
  }
  std::string import_error(const std::string& name, const ImportOptions& options = {}) const {
    return error_of([&] { import(name, options); });
  }
  template <class T>
  void write_npy(const std::string& name, const char* dtype, const std::vector<Vec3<T>>& rows) {
    NpyWriter writer(path(name), dtype, {3}, sizeof(T), rows.size());
    writer.write_rows(rows.data(), rows.size());
    writer.commit();
  }

  TempDir dir_;
};

ImportOptions with_levels(int levels) {
  ImportOptions options;
  options.resolution = std::int64_t{1} << levels;
  return options;
}

TEST_F(Import, ArraysOfVoxelsKeepTheirNumbers) {
  for (const int levels : {2, 3, 5})
    for (const NamedVoxels& set : voxel_sets(levels, 3)) {
      write_npy("v.npy", "<i4", set.voxels);
      const ImportResult result = import("v.npy", with_levels(levels));
      EXPECT_EQ(result.dag, brute_svdag(levels, set.voxels)) << set.name;
      EXPECT_EQ(result.read, set.voxels.size());
    }
  write_npy<std::int32_t>("v.npy", "<i4", {{7, 0, 0}, {0, 8, 1}});
  EXPECT_EQ(import("v.npy").grid.levels, 4);
  write_npy<std::int32_t>("v.npy", "<i4", {{-1, 0, 0}});
  EXPECT_NE(import_error("v.npy").find("voxel (-1, 0, 0) lies outside"), std::string::npos);
  write_npy<std::int32_t>("v.npy", "<i4", {{0, 1 << 20, 0}});
  EXPECT_NE(import_error("v.npy").find("beyond 1048575"), std::string::npos);
}

/// Returns points in a box, and their voxels in the grid that holds their bounds.
std::vector<Vec3d> random_points(int count, unsigned seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> x(-3, 9), y(100, 104), z(0.5, 0.75);
  std::vector<Vec3d> points;
  for (int i = 0; i < count; ++i) points.push_back({x(rng), y(rng), z(rng)});
  return points;
}

std::vector<Vec3i> voxels_of(const std::vector<Vec3d>& points, const Grid& grid) {
  std::vector<Vec3i> voxels;
  for (const Vec3d p : points) {
    Vec3i v;
    for (int axis = 0; axis < 3; ++axis)
      v[axis] = static_cast<std::int32_t>(
          std::min<double>(std::floor((p[axis] - grid.origin[axis]) / grid.voxel_size),
                           static_cast<double>(grid.resolution() - 1)));
    voxels.push_back(v);
  }
  return voxels;
}

TEST_F(Import, PointsSetTheirVoxels) {
  const std::vector<Vec3d> points = random_points(5'000, 1);
  write_npy("p.npy", "<f8", points);
  const ImportResult result = import("p.npy", with_levels(6));
  EXPECT_EQ(result.dag, brute_svdag(6, voxels_of(points, result.grid)));
  EXPECT_EQ(result.outside, 0u);
  ImportOptions options;
  options.voxel_size = 0.25;
  const ImportResult sized = import("p.npy", options);
  EXPECT_EQ(sized.grid.voxel_size, 0.25);
  EXPECT_EQ(sized.grid.levels, 6);
  EXPECT_EQ(sized.dag, brute_svdag(6, voxels_of(points, sized.grid)));

  std::vector<Vec3f> singles(points.begin(), points.end());
  write_npy("f.npy", "<f4", singles);
  const ImportResult of_floats = import("f.npy", with_levels(5));
  EXPECT_EQ(of_floats.dag,
            brute_svdag(5, voxels_of({singles.begin(), singles.end()}, of_floats.grid)));
}

TEST_F(Import, PointsOutsideOfGivenBoundsAreLeftOut) {
  write_npy<double>("p.npy", "<f8", {{0, 0, 0}, {0.99, 0.5, 0.5}, {1, 0, 0}, {-0.01, 0, 0}});
  ImportOptions options = with_levels(3);
  options.bounds = Box3d{{0, 0, 0}, {1, 1, 1}};
  const ImportResult result = import("p.npy", options);
  EXPECT_EQ(result.outside, 2u);
  EXPECT_EQ(result.dag, brute_svdag(3, {{0, 0, 0}, {7, 4, 4}}));
}

TEST_F(Import, OnePointHasAGrid) {
  write_npy<double>("p.npy", "<f8", {{5, 6, 7}});
  const ImportResult result = import("p.npy", with_levels(4));
  EXPECT_EQ(result.grid.voxel_size, 1);
  EXPECT_EQ(result.dag, brute_svdag(4, {{0, 0, 0}}));
  write_npy<double>("p.npy", "<f8", {});
  EXPECT_NE(import_error("p.npy", with_levels(4)).find("has no points"), std::string::npos);
  write_npy<double>("p.npy", "<f8", {{0, 0, 0}, {0, std::nan(""), 0}, {HUGE_VAL, 0, 0}, {3, 0, 0}});
  const ImportResult finite = import("p.npy", with_levels(2));
  EXPECT_EQ(finite.dag, brute_svdag(2, {{0, 0, 0}, {3, 0, 0}}));
  EXPECT_EQ(finite.read, 4u);
  EXPECT_EQ(finite.not_finite, 2u);
}

TEST_F(Import, ArraysOfOtherTypesAreRefused) {
  NpyWriter writer(path("a.npy"), "<f4", {4}, 4, 0);
  writer.commit();
  EXPECT_NE(import_error("a.npy").find("is no array of shape (N, 3)"), std::string::npos);
  EXPECT_NE(import_error("none.npy").find("none.npy"), std::string::npos);
  std::filesystem::copy_file(path("a.npy"), path("a.xyy"));
  EXPECT_NE(import_error("a.xyy").find("is none of"), std::string::npos);
}

TEST_F(Import, RowsOfArraysTellTheRangeOfTheirColors) {
  const auto expect = [&]<class T>(const char* type, std::array<T, 3> color, bool is_unsure) {
    const std::array<float, 3> place{1, 2, 3};
    NpyWriter writer(path("c.npy"),
                     std::string("[('xyz', '<f4', (3,)), ('rgb', '") + type + "', (3,))]", {},
                     12 + sizeof color, 1);
    writer.write_bytes(place.data(), 12);
    writer.write_bytes(color.data(), sizeof color);
    writer.commit();
    const auto source = open_voxel_source(path("c.npy"));
    EXPECT_EQ(source->warnings().size(), is_unsure ? 1u : 0u) << type;
    source->visit_all([&](const VoxelBatch& batch) {
      ASSERT_EQ(batch.colors.size(), 1u);
      EXPECT_EQ(batch.colors[0], (Rgb8{255, 51, 0})) << type;
    });
  };
  expect("|u1", std::array<std::uint8_t, 3>{255, 51, 0}, false);
  expect("<u2", std::array<std::uint16_t, 3>{65535, 13107, 0}, false);
  expect("<u2", std::array<std::uint16_t, 3>{255, 51, 0}, true);
  expect("<f4", std::array<float, 3>{1, 0.2f, 0}, false);
  expect("<f8", std::array<double, 3>{255, 51, 0}, false);
}

TEST_F(Import, TextsOfPointsAreRead) {
  write_text(path("p.xyz"),
             "# x y z\n0 0 0 255 0 0\n\n  1.5\t2e0,+3; 7 # the last one\r\n-1,-1,-1\n4 4 4");
  const ImportResult result = import("p.xyz", with_levels(3));
  EXPECT_EQ(result.read, 4u);
  EXPECT_EQ(result.dag, brute_svdag(3, voxels_of({{0, 0, 0}, {1.5, 2, 3}, {-1, -1, -1}, {4, 4, 4}},
                                                 result.grid)));
  const auto error = [&](const std::string& text) {
    write_text(path("p.xyz"), text);
    return import_error("p.xyz", with_levels(3));
  };
  EXPECT_NE(error("1 2 3\n1 2\n").find("line 2"), std::string::npos);
  EXPECT_NE(error("1 2 3\n1 2\n").find("has 2 numbers instead of three"), std::string::npos);
  EXPECT_NE(error("1 2 x\n").find("line 1: number 3, 'x', is not a number"), std::string::npos);
  EXPECT_NE(error("1 2 nan\n").find("points that are not finite"), std::string::npos);
  EXPECT_NE(error("1 2 1e999\n").find("points that are not finite"), std::string::npos);
  EXPECT_NE(error("1 2 3x\n").find("number 3"), std::string::npos);
  EXPECT_NE(error(std::string(std::size_t{1} << 21, ' ')).find("longer than 1 MiB"),
            std::string::npos);
  EXPECT_NE(error("").find("has no points"), std::string::npos);
}

TEST_F(Import, TextsTellTheRangeOfTheirColors) {
  const auto color_of = [&](const std::string& text) {
    write_text(path("p.csv"), text);
    Rgb8 color{};
    open_voxel_source(path("p.csv"))->visit_all([&](const VoxelBatch& batch) {
      if (!batch.colors.empty()) color = batch.colors[0];
    });
    return color;
  };
  EXPECT_EQ(color_of("x,y,z,r,g,b\n0.5,0.5,0.5,1.0,0.0,0.0\n"), (Rgb8{255, 0, 0}));
  EXPECT_EQ(color_of("x,y,z,r,g,b\n0,0,0,1,0,1\n"), (Rgb8{1, 0, 1}));
  EXPECT_EQ(color_of("x,y,z,r,g,b\n0,0,0,65535,0,257\n"), (Rgb8{255, 0, 1}));
  EXPECT_EQ(color_of("1 2 3 255 128 0\n"), (Rgb8{255, 128, 0}));
  EXPECT_EQ(color_of("1 2 3 0 0 1 255 128 0\n"), (Rgb8{255, 128, 0}));  // behind a normal
  EXPECT_EQ(color_of("//X Y Z R8 G8 B8\n1 2 3 1 0 1\n1 2 3 9 9 9\n"), (Rgb8{1, 0, 1}));
  EXPECT_EQ(color_of("//X Y Z Rf Gf Bf\n1 2 3 0.2 0 1\n"), (Rgb8{51, 0, 255}));
}

TEST_F(Import, ColoursWithoutNamesAreAGuess) {
  const auto open = [&](const std::string& text) {
    write_text(path("p.xyz"), text);
    return open_voxel_source(path("p.xyz"));
  };
  std::string text = "1 2 3 255 128 0\n";
  const auto guessed = open(text);
  EXPECT_TRUE(guessed->has_colors());
  EXPECT_TRUE(guessed->warnings().empty());
  // A later line, behind those that the reader looks at first, is no colour.
  for (int i = 1; i < 5'000; ++i) text += "1 2 3 255 128 0\n";
  for (const char* last : {"1 2 3 255 256 0\n", "1 2 3 255 128 0.5\n", "1 2 3\n"}) {
    const auto dropped = open(text + last);
    EXPECT_FALSE(dropped->has_colors());
    EXPECT_EQ(dropped->warnings(),
              std::vector<std::string>{"its columns 4 to 6 are left out: they have no names, and "
                                       "line 5001 has no colour there"});
    EXPECT_EQ(import("p.xyz", with_levels(3)).read, 5'001u);
  }
}

TEST_F(Import, TextsMayHaveCoordinatesThatAreNoNumbers) {
  const auto counts = [&](const std::string& text) {
    write_text(path("p.csv"), text);
    const ImportResult result = import("p.csv", with_levels(3));
    return std::pair(result.read, result.not_finite);
  };
  using Counts = std::pair<std::uint64_t, std::uint64_t>;
  EXPECT_EQ(counts("x,y,z\n0,0,0\n1,,3\n,,\n4,4,\n1,2,3\n"), (Counts{5, 3}));
  EXPECT_EQ(counts(",2,3\n0;0;0\n1;2;3\n"), (Counts{3, 1}));
  EXPECT_EQ(counts("1.#QNAN 1 1\n0 0 0 # one\n-1.#IND00 2 3\n1 2 1.#INF # two\n1 2 3\n"),
            (Counts{5, 3}));
  // Blanks alone hold no empty field.
  EXPECT_EQ(counts("0  0\t0\n1 2 3 \n"), (Counts{2, 0}));
}

/// Returns a binvox file of a grid of `side` voxels.
std::string binvox_of(int side, const std::vector<Vec3i>& voxels) {
  const auto n = static_cast<std::size_t>(side);
  std::vector<bool> set(n * n * n);
  for (const Vec3i v : voxels)
    set[static_cast<std::size_t>(v.x) * n * n + static_cast<std::size_t>(v.z) * n +
        static_cast<std::size_t>(v.y)] = true;
  std::string text = "#binvox 1\ndim " + std::to_string(side) + " " + std::to_string(side) + " " +
                     std::to_string(side) + "\ntranslate -1 2 0.5\nscale 4\ndata\n";
  for (std::size_t i = 0; i < set.size();) {
    std::size_t end = i;
    while (end < set.size() && end - i < 255 && set[end] == set[i]) ++end;
    text += static_cast<char>(set[i]);
    text += static_cast<char>(end - i);
    i = end;
  }
  return text;
}

TEST_F(Import, BinvoxFilesHaveTheirGrid) {
  for (const NamedVoxels& set : voxel_sets(4, 9)) {
    write_text(path("b.binvox"), binvox_of(16, set.voxels));
    const ImportResult result = import("b.binvox");
    EXPECT_EQ(result.dag, brute_svdag(4, set.voxels)) << set.name;
    EXPECT_EQ(result.grid.origin, (Vec3d{-1, 2, 0.5}));
    EXPECT_EQ(result.grid.voxel_size, 0.25);
  }
  write_text(path("b.binvox"), binvox_of(5, {{4, 3, 0}}));
  EXPECT_EQ(import("b.binvox").dag, brute_svdag(3, {{4, 3, 0}}));
}

TEST_F(Import, EveryTruncatedOrDamagedBinvoxFileIsRefusedOrSafe) {
  const std::string good = binvox_of(6, {{1, 2, 3}, {5, 5, 5}, {0, 0, 0}});
  for (std::size_t size = 0; size < good.size(); ++size) {
    write_text(path("b.binvox"), good.substr(0, size));
    EXPECT_NE(import_error("b.binvox"), "no error") << size;
  }
  int refused = 0;
  for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
    std::string bad = good;
    bad[bit / 8] ^= static_cast<char>(1 << bit % 8);
    write_text(path("b.binvox"), bad);
    refused += import_error("b.binvox") != "no error" ? 1 : 0;
  }
  EXPECT_GT(refused, 100);
  const auto error = [&](const std::string& text) {
    write_text(path("b.binvox"), text);
    return import_error("b.binvox");
  };
  EXPECT_NE(error("#binvox 1\ndim 4 4 5\ndata\n").find("three equal whole numbers"),
            std::string::npos);
  EXPECT_NE(error("#binvox 1\ndim 1e9 1e9 1e9\ndata\n").find("three equal whole numbers"),
            std::string::npos);
  EXPECT_NE(error("#binvox 1\ndim 4 4 4\nscale 0\ndata\n").find("scale"), std::string::npos);
}

}  // namespace
}  // namespace voxdag
