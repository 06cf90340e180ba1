// Tests baked ambient occlusion: at points with known occlusion, and in the colours of an ESVO.
#include "voxdag/cpu/surface_openness.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "support/grid_mesh.hpp"
#include "voxdag/builders/esvo/build/build_esvo.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/core/srgb.hpp"
#include "voxdag/stored/esvo/color_block.hpp"

namespace voxdag {
namespace {

constexpr int kLevels = 7;  // 128³ voxels, the unit of length
constexpr double kReach = 32;

Grid unit_grid() { return {kLevels, {0, 0, 0}, 1.0, kSubvoxels}; }

/// Returns a floor at y = 8.5 and, if `with_wall`, a wall at x = 40.5 that stands on it.
Mesh floor_and_wall(bool with_wall) {
  Mesh mesh = test::grid_mesh(1, [](int i, int j) {
    return Vec3f{128.0f * static_cast<float>(j), 8.5f, 128.0f * static_cast<float>(i)};
  });
  if (!with_wall) return mesh;
  const Mesh wall = test::grid_mesh(1, [](int i, int j) {
    return Vec3f{40.5f, 8.5f + 119.0f * static_cast<float>(j), 128.0f * static_cast<float>(i)};
  });
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), wall.vertices.begin(), wall.vertices.end());
  for (const Triangle& t : wall.triangles)
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return mesh;
}

struct Leaf {
  Vec3f color;
  double centre_x, side;
};
std::vector<Leaf> leaves_of(const EsvoView& esvo) {
  std::vector<Leaf> leaves;
  const auto walk = [&](const auto& self, std::uint64_t slot, Vec3i cell, int level) -> void {
    const ChildDescriptor d = esvo.descriptor(slot);
    for (int i = 0; i < 8; ++i) {
      if ((d.valid_mask() >> i & 1) == 0) continue;
      const Vec3i at = cell * 2 + child_offset(i);
      if ((d.leaf_mask() >> i & 1) == 0) {
        self(self, esvo.child(slot, d, i), at, level + 1);
        continue;
      }
      const std::uint64_t* block = esvo.attachment(slot, EsvoAttachmentKind::kColors);
      const double side = 128.0 / (2 << level);
      leaves.push_back(
          {ColorBlock{*block}.color(attachment_value({slot, i})), (at.x + 0.5) * side, side});
    }
  };
  walk(walk, esvo.root, {}, 0);
  return leaves;
}

class OpennessOfAFloor : public testing::Test {
 protected:
  /// Returns the openness at a distance from the wall.
  static float open_at(const SurfaceOpenness& openness, double distance) {
    return openness({40.5 + distance, 8.5, 64}, {0, 1, 0}, {0, 1, 0});
  }
};

TEST_F(OpennessOfAFloor, IsOneWithoutAnythingNear) {
  const Esvo esvo = build_esvo(floor_and_wall(false), unit_grid());
  const SurfaceOpenness openness(esvo.view(), unit_grid(), 256, kReach);
  for (double x = 1; x < 80; x += 1.7) EXPECT_EQ(open_at(openness, x), 1.0f) << x;
}

TEST_F(OpennessOfAFloor, FallsTowardsAWallToOneHalf) {
  const Esvo esvo = build_esvo(floor_and_wall(true), unit_grid());
  const SurfaceOpenness openness(esvo.view(), unit_grid(), 1024, kReach);
  EXPECT_EQ(open_at(openness, kReach + 1), 1.0f);
  // A wall at the point hides half of the sky, even for short rays.
  EXPECT_NEAR(open_at(openness, 0.3), 0.58f, 0.12f) << "rays start beside the voxels of the wall";
  float before = 0;
  for (const double distance : {1.0, 4.0, 8.0, 16.0, 28.0}) {
    const float open = open_at(openness, distance);
    EXPECT_GT(open, before) << distance;
    before = open;
  }
  EXPECT_GT(open_at(openness, 28), 0.98f);
}

TEST(BakedLight, MultipliesTheColoursOfLeaves) {
  EsvoOptions options;
  const Mesh floor = floor_and_wall(false);
  const Esvo plain = build_esvo(floor, unit_grid(), options);
  options.settings.light = [](const SurfacePlace& place) {
    EXPECT_NEAR(place.point.y, 8.5, 1e-6);
    EXPECT_EQ(place.face.x, 0);
    return place.point.x < 64 ? 1.0f : 0.25f;
  };
  const Esvo lit = build_esvo(floor, unit_grid(), options);

  const Vec3f bright = leaves_of(plain.view()).front().color;
  const auto leaves = leaves_of(lit.view());
  EXPECT_GE(leaves.size(), 2u);
  for (const Leaf& leaf : leaves) {
    ASSERT_TRUE(leaf.centre_x + leaf.side / 2 <= 64 || leaf.centre_x - leaf.side / 2 >= 64)
        << "lit in part";
    const float expected = srgb_to_linear(bright.x) * (leaf.centre_x < 64 ? 1.0f : 0.25f);
    EXPECT_NEAR(leaf.color.x, linear_to_srgb(expected), 0.02f);
  }
}

TEST(BakedLight, EndsLeavesWhereItChanges) {
  EsvoOptions options;
  options.settings.light = [](const SurfacePlace& place) {
    return place.point.x < 37 ? 1.0f : 0.25f;
  };
  const Esvo esvo = build_esvo(floor_and_wall(false), unit_grid(), options);
  const Esvo plain = build_esvo(floor_and_wall(false), unit_grid());
  EXPECT_GT(leaves_of(esvo.view()).size(), 2 * leaves_of(plain.view()).size());
}

}  // namespace
}  // namespace voxdag
