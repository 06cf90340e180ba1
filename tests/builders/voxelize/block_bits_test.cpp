#include "voxdag/builders/voxelize/block_bits.hpp"

#include <gtest/gtest.h>

#include <random>

#include "voxdag/core/morton.hpp"

namespace voxdag {
namespace {

Vec3i voxel_of(int bit) { return {bit & 3, (bit >> 2) & 3, bit >> 4}; }

TEST(LinearToMorton, MovesEveryVoxelToItsMortonCode) {
  for (int bit = 0; bit < 64; ++bit)
    EXPECT_EQ(linear_to_morton(std::uint64_t{1} << bit),
              std::uint64_t{1} << morton_encode(voxel_of(bit)));
}

TEST(ExpandSquare, RepeatsTheSquareAlongTheProjectionsAxis) {
  constexpr int kU[3] = {1, 0, 0}, kV[3] = {2, 2, 1};
  for (int projection = 0; projection < 3; ++projection)
    for (int square = 0; square < 16; ++square) {
      const std::uint64_t mask = expand_square(projection, std::uint64_t{1} << square);
      for (int bit = 0; bit < 64; ++bit) {
        const Vec3i voxel = voxel_of(bit);
        const bool expected = voxel[kU[projection]] + 4 * voxel[kV[projection]] == square;
        EXPECT_EQ(((mask >> bit) & 1) != 0, expected);
      }
    }
}

TEST(BoxMask, HasTheVoxelsOfTheBoxAndNoOther) {
  std::mt19937 random(3);
  const auto below = [&](unsigned n) { return static_cast<std::int32_t>(random() % n); };
  for (int round = 0; round < 2000; ++round) {
    const Vec3i lo{below(12) - 2, below(12) - 2, below(12) - 2};
    const Vec3i hi = lo + Vec3i{below(6), below(6), below(6)};
    const std::uint64_t mask = box_mask({4, 4, 4}, lo, hi);
    for (int bit = 0; bit < 64; ++bit) {
      const Vec3i v = voxel_of(bit) + Vec3i{4, 4, 4};
      const bool expected =
          v.x >= lo.x && v.x <= hi.x && v.y >= lo.y && v.y <= hi.y && v.z >= lo.z && v.z <= hi.z;
      ASSERT_EQ(((mask >> bit) & 1) != 0, expected);
    }
  }
}

}  // namespace
}  // namespace voxdag
