// Tests exports of ESVOs: the voxels that leaves stand for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "support/grid_mesh.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/esvo/build/build_esvo.hpp"
#include "voxdag/formats/exports/export_voxels.hpp"

namespace voxdag {
namespace {

constexpr int kLevels = 7;

Grid unit_grid() { return {kLevels, {0, 0, 0}, 1.0, kSubvoxels}; }

/// Returns hills over the grid's floor.
Mesh hills() {
  return test::grid_mesh(24, [](int i, int j) {
    const float x = 126.0f * static_cast<float>(i) / 24, z = 126.0f * static_cast<float>(j) / 24;
    return Vec3f{1 + x, 40 + 20 * std::sin(x / 20) + 12 * std::cos(z / 13), 1 + z};
  });
}

std::vector<std::uint64_t> codes_of(const VoxelSet& voxels, const Box3i& window) {
  std::vector<std::uint64_t> codes;
  voxels.for_each_voxel(window, [&](Vec3i v) { codes.push_back(morton_encode(v)); });
  return codes;
}

class ExportEsvo : public testing::Test {
 protected:
  const Svdag dag_ = build_svdag(hills(), unit_grid()).dag;
  const Box3i all_ = whole_grid(kLevels);
};

TEST_F(ExportEsvo, CubesAreTheVoxelsOfTheDag) {
  EsvoOptions options;
  options.settings.contours = false;
  const Esvo esvo = build_esvo(hills(), unit_grid(), options);
  EXPECT_EQ(codes_of(esvo.view(), all_), codes_of(dag_.view(), all_));
}

TEST_F(ExportEsvo, CoarseLeavesStandForAllVoxelsOfTheCoverAndFewMore) {
  const Esvo esvo = build_esvo(hills(), unit_grid());
  const std::vector<std::uint64_t> voxels = codes_of(esvo.view(), all_);
  const std::vector<std::uint64_t> cover = codes_of(dag_.view(), all_);
  EXPECT_TRUE(std::is_sorted(voxels.begin(), voxels.end()));
  EXPECT_EQ(std::adjacent_find(voxels.begin(), voxels.end()), voxels.end());
  EXPECT_TRUE(std::includes(voxels.begin(), voxels.end(), cover.begin(), cover.end()));
  EXPECT_LT(voxels.size(), cover.size() * 5 / 4);
}

TEST_F(ExportEsvo, WindowsAndLookupsAgreeWithTheWhole) {
  const Esvo esvo = build_esvo(hills(), unit_grid());
  const VoxelSet set = esvo.view();
  const std::vector<std::uint64_t> voxels = codes_of(set, all_);
  std::mt19937 random(5);
  for (int round = 0; round < 50; ++round) {
    Box3i window;
    for (int axis = 0; axis < 3; ++axis) {
      window.lo[axis] = static_cast<std::int32_t>(random() % 120);
      window.hi[axis] = window.lo[axis] + 1 + static_cast<std::int32_t>(random() % 40);
    }
    std::vector<std::uint64_t> expected;
    for (const std::uint64_t code : voxels) {
      const Vec3i v = morton_decode(code);
      bool inside = true;
      for (int axis = 0; axis < 3; ++axis)
        inside &= v[axis] >= window.lo[axis] && v[axis] < window.hi[axis];
      if (inside) expected.push_back(code);
    }
    EXPECT_EQ(codes_of(set, window), expected);
    const std::uint64_t block = set.leaf_block_at(window.lo);
    for (std::uint64_t i = 0; i < 64; ++i) {
      const Vec3i v =
          Vec3i{window.lo.x & ~3, window.lo.y & ~3, window.lo.z & ~3} + morton_decode(i);
      EXPECT_EQ(block >> i & 1,
                std::binary_search(voxels.begin(), voxels.end(), morton_encode(v)) ? 1u : 0u);
    }
  }
}

TEST_F(ExportEsvo, PointsHaveNormalsAndColours) {
  const TempDir dir;
  const Esvo esvo = build_esvo(hills(), unit_grid());
  ExportOptions options;
  options.look = esvo.view();
  export_voxels(dir.path() / "points.ply", esvo.view(), unit_grid(), {}, options);
  const std::string text = read_text(dir.path() / "points.ply");
  for (const char* property :
       {"property float nx", "property float nz", "property uchar red", "property uchar blue"})
    EXPECT_NE(text.find(property), std::string::npos) << property;
  const std::size_t voxels = codes_of(esvo.view(), all_).size();
  EXPECT_NE(text.find("element vertex " + std::to_string(voxels) + "\n"), std::string::npos);
  const std::string end = "end_header\n";
  const std::size_t begin = text.find(end) + end.size(), record = 6 * sizeof(float) + 3;
  ASSERT_EQ(text.size() - begin, voxels * record);
  for (std::size_t i = 0; i < voxels; ++i) {
    float values[6];
    std::memcpy(values, text.data() + begin + i * record, sizeof values);
    EXPECT_NEAR(values[3] * values[3] + values[4] * values[4] + values[5] * values[5], 1, 1e-3);
    EXPECT_GT(std::fabs(values[4]), 0.3f) << "hills are not that steep";
  }
}

}  // namespace
}  // namespace voxdag
