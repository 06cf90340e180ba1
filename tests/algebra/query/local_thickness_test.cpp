#include "voxdag/algebra/query/local_thickness.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "algebra/brute_depths.hpp"
#include "support/voxel_sets.hpp"

namespace voxdag {
namespace {

std::uint32_t square_at(const LocalThickness& field, Vec3i v) {
  const Vec3<std::size_t> size(field.box.hi - field.box.lo), at(v - field.box.lo);
  return field.squares[(at.z * size.y + at.y) * size.x + at.x];
}

template <class Keep>
LocalThickness thickness_of(int levels, const Keep& keep) {
  return local_thickness(VoxelGrid::dag_of(levels, keep).view());
}

TEST(LocalThickness, IsThatOfTheLargestOfAllBalls) {
  constexpr int kLevels = 4;
  for (int seed = 0; seed < 6; ++seed) {
    const auto keep = [&](Vec3i v) {  // Bodies of balls, and places that are missing in them.
      const auto in = [&](int x, int y, int z, int r) {
        return (v.x - x) * (v.x - x) + (v.y - y) * (v.y - y) + (v.z - z) * (v.z - z) <= r * r;
      };
      return (in(5 + seed, 7, 6, 6) || in(11, 9 - seed, 10, 4) || v.z < seed) &&
             (v.x * 31 + v.y * 17 + v.z * 7 + seed) % (40 * seed + 29) != 0;
    };
    const std::vector<Vec3i> voxels = voxels_where(kLevels, keep);
    const VoxelGrid grid(kLevels, voxels);
    std::vector<std::int64_t> squares;
    for (const Vec3i v : voxels) squares.push_back(brute_depth_square(grid, v));
    const LocalThickness field = thickness_of(kLevels, keep);
    for (const Vec3i p : voxels) {
      std::int64_t most = 0;
      for (std::size_t i = 0; i < voxels.size(); ++i) {
        const Vec3i apart = p - voxels[i];
        if (4 * dot(apart, apart) <= squares[i]) most = std::max(most, squares[i]);
      }
      ASSERT_EQ(square_at(field, p), most) << seed << ": " << p.x << "," << p.y << "," << p.z;
    }
  }
}

TEST(LocalThickness, OfAPlateIsItsHeightIfThatIsOdd) {
  constexpr int kLevels = 6;
  for (const std::int32_t height : {1, 2, 5, 8}) {
    const LocalThickness field =
        thickness_of(kLevels, [&](Vec3i v) { return v.z >= 3 && v.z < 3 + height; });
    const auto odd = static_cast<std::uint32_t>(height - (height % 2 == 0 ? 1 : 0));
    // Away from the edges of the plate.
    for (std::int32_t z = 3; z < 3 + height; ++z)
      EXPECT_EQ(square_at(field, {32, 20, z}), odd * odd) << height;
    EXPECT_EQ(square_at(field, {32, 20, 2}), 0u);
  }
}

TEST(LocalThickness, OfABallIsItsDiameter) {
  constexpr int kLevels = 6;
  constexpr double kRadius = 20;
  const auto in = [](Vec3i v) {
    const Vec3d p = Vec3d(v) - Vec3d{32, 32, 32};
    return dot(p, p) <= kRadius * kRadius;
  };
  const LocalThickness field = thickness_of(kLevels, in);
  const double most = std::sqrt(square_at(field, {32, 32, 32}));
  // The nearest empty centre is more than 20 voxels away, its cube half a diagonal less.
  EXPECT_GE(most, 2 * (kRadius - std::sqrt(0.75)));
  EXPECT_LE(most, 2 * kRadius + 1);
  for (const Vec3i v : voxels_where(kLevels, in)) {
    const Vec3d p = Vec3d(v) - Vec3d{32, 32, 32};
    if (4 * dot(p, p) <= most * most) {
      EXPECT_EQ(square_at(field, v), square_at(field, {32, 32, 32}));
    }
  }
}

TEST(LocalThickness, KeepsItsMemoryLimitOrIsRefused) {
  const Svdag body = VoxelGrid::dag_of(6, [](Vec3i v) { return v.x > 3; });
  MemoryBudget much(std::uint64_t{16} << 20), little(std::uint64_t{1} << 20);
  EXPECT_EQ(local_thickness(body.view(), Work(&much)).squares,
            local_thickness(body.view()).squares);
  EXPECT_LE(much.peak(), std::uint64_t{16} << 20);
  EXPECT_THROW(local_thickness(body.view(), Work(&little)), OverMemory);
  EXPECT_EQ(little.used(), 0u);
  EXPECT_TRUE(thickness_of(3, [](Vec3i) { return false; }).squares.empty());
}

}  // namespace
}  // namespace voxdag
