#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "voxdag/stored/esvo/color_block.hpp"
#include "voxdag/stored/esvo/normal_block.hpp"

namespace voxdag {
namespace {

float angle_between(Vec3f a, Vec3f b) {
  const Vec3f c = cross(a, b);
  return std::atan2(std::sqrt(dot(c, c)), dot(a, b));
}

TEST(ColorBlock, EveryRgb565SurvivesPacking) {
  for (std::uint32_t bits = 0; bits < 65536; ++bits) ASSERT_EQ(Rgb565::unpack(bits).pack(), bits);
}

TEST(ColorBlock, BitsAreWhereTheHeaderSays) {
  const ColorBlock block = ColorBlock::pack({1, 2, 3}, {4, 5, 6}, 0xE4u);
  EXPECT_EQ(block.bits,
            0xE4ull << 32 | (4u << 11 | 5u << 5 | 6u) << 16 | (1u << 11 | 2u << 5 | 3u));
  EXPECT_EQ(block.c0(), (Rgb565{1, 2, 3}));
  EXPECT_EQ(block.c1(), (Rgb565{4, 5, 6}));
  for (int i = 0; i < 4; ++i) EXPECT_EQ(block.selector(i), i);
  EXPECT_EQ(block.selector(4), 0);
}

TEST(ColorBlock, DecodesThePapersFourColours) {
  const ColorBlock block = ColorBlock::pack({31, 63, 31}, {0, 0, 0}, 0xE4u);
  EXPECT_EQ(block.color(0), (Vec3f{1, 1, 1}));
  EXPECT_EQ(block.color(1), (Vec3f{0, 0, 0}));
  EXPECT_FLOAT_EQ(block.color(2).x, 2.0f / 3.0f);
  EXPECT_FLOAT_EQ(block.color(2).y, 2.0f / 3.0f);
  EXPECT_FLOAT_EQ(block.color(3).z, 1.0f / 3.0f);
}

TEST(ColorBlock, TheOrderOfTheEndsHasNoMeaning) {
  const ColorBlock up = ColorBlock::pack({1, 40, 9}, {20, 3, 30}, 0x0000001Bu);
  const ColorBlock down = ColorBlock::pack({20, 3, 30}, {1, 40, 9}, 0x0000004Eu);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(up.color(i), down.color(i));
}

TEST(NormalBlock, EveryFieldSurvivesPacking) {
  std::mt19937 random(7);
  for (int i = 0; i < 10000; ++i) {
    const CubePoint base{static_cast<int>(random() % 6), static_cast<int>(random() % 32768),
                         static_cast<int>(random() % 16384)};
    const auto axis = [&random] {
      const auto component = [&random] { return static_cast<int>(random() % 16) - 8; };
      return GridAxis{component(), component(), component(), static_cast<int>(random() % 16)};
    };
    const GridAxis u = axis(), v = axis();
    const auto u_steps = static_cast<std::uint32_t>(random());
    const auto v_steps = static_cast<std::uint32_t>(random());
    const NormalBlock block = NormalBlock::pack(base, u, v, u_steps, v_steps);
    ASSERT_EQ(block.base(), base);
    ASSERT_EQ(block.u_axis(), u);
    ASSERT_EQ(block.v_axis(), v);
    for (int k = 0; k < kValuesPerBlock; ++k) {
      ASSERT_EQ(static_cast<std::uint32_t>(block.u_step(k)), u_steps >> (2 * k) & 3u);
      ASSERT_EQ(static_cast<std::uint32_t>(block.v_step(k)), v_steps >> (2 * k) & 3u);
    }
  }
}

TEST(NormalBlock, BitsAreWhereTheHeaderSays) {
  const NormalBlock block = NormalBlock::pack({5, 3, 9}, {-1, 2, -8, 4}, {7, 0, -3, 15}, 1, 2);
  EXPECT_EQ(block.words[0], 5u << 29 | 3u << 14 | 9u);
  EXPECT_EQ(block.words[1], 0xFD07482Fu);
  EXPECT_EQ(block.u_axis().vector(), (Vec3f{-1, 2, -8} * 0.000244140625f));
  EXPECT_EQ(block.v_axis().vector(), (Vec3f{7, 0, -3} * 0.5f));
}

TEST(NormalBlock, AxesAndDiagonalsAreExact) {
  const GridAxis none;
  for (int face = 0; face < 6; ++face) {
    const Vec3f n = NormalBlock::pack({face, 16384, 8192}, none, none, 0, 0).normal(3);
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_EQ(n[axis], axis == face / 2 ? (face % 2 != 0 ? -1.0f : 1.0f) : 0.0f);
  }
  const Vec3f diagonal = CubePoint{0, 32767, 1}.position();
  EXPECT_EQ(diagonal, (Vec3f{1, 1, -1}));
}

TEST(NormalBlock, TheGridIsThePapers) {
  // Base z, axes x/2 and y/2. The outer steps give (±1/2, ±1/2, 1), the inner ones a third of that
  // offset.
  const GridAxis x{4, 0, 0, 13}, y{0, 4, 0, 13};
  for (int u = 0; u < 4; ++u)
    for (int v = 0; v < 4; ++v) {
      const NormalBlock block = NormalBlock::pack({4, 16384, 8192}, x, y, static_cast<unsigned>(u),
                                                  static_cast<unsigned>(v));
      const float c[4] = {-1.0f, -1.0f / 3.0f, 1.0f / 3.0f, 1.0f};
      EXPECT_LT(angle_between(block.normal(0), Vec3f{c[u] / 2, c[v] / 2, 1}), 1e-6f);
      EXPECT_NEAR(dot(block.normal(0), block.normal(0)), 1.0f, 1e-6f);
    }
}

TEST(NormalBlock, AZeroPointOfTheGridGivesTheBase) {
  // Base z, u axis z: the step -1 gives the zero vector.
  const NormalBlock block = NormalBlock::pack({4, 16384, 8192}, {0, 0, 2, 15}, {}, 0, 0);
  EXPECT_EQ(block.normal(0), (Vec3f{0, 0, 1}));
}

TEST(NormalBlock, AnyBitsDecodeToUnitLength) {
  std::mt19937 random(3);
  for (int i = 0; i < 20000; ++i) {
    NormalBlock block;
    for (std::uint32_t& word : block.words) word = static_cast<std::uint32_t>(random());
    const Vec3f n = block.normal(static_cast<int>(random() % 16));
    ASSERT_NEAR(dot(n, n), 1.0f, 1e-5f);
  }
}

}  // namespace
}  // namespace voxdag
