#include "voxdag/builders/esvo/encode/encode_normal_block.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <thread>
#include <vector>

#include "voxdag/builders/esvo/encode/encode_pair.hpp"

namespace voxdag {
namespace {

using Normals = std::array<Vec3f, kValuesPerBlock>;

double degrees_between(Vec3f a, Vec3f b) {
  const Vec3d c = cross(Vec3d(a), Vec3d(b));
  return std::atan2(std::sqrt(dot(c, c)), dot(Vec3d(a), Vec3d(b))) * 57.29577951308232;
}

struct Angles {
  double sum = 0, max = 0;
  int count = 0;

  double mean() const { return sum / count; }
  void add(const Normals& normals, std::uint32_t used, const NormalBlock& block) {
    for (int i = 0; i < kValuesPerBlock; ++i) {
      if ((used >> i & 1u) == 0) continue;
      const double angle = degrees_between(normals[static_cast<std::size_t>(i)], block.normal(i));
      sum += angle;
      max = std::max(max, angle);
      ++count;
    }
  }
};

float uniform(std::mt19937& random) { return static_cast<float>(random() >> 8) / 16777216.0f; }

Vec3f random_direction(std::mt19937& random) {
  for (;;) {
    const Vec3f v{2 * uniform(random) - 1, 2 * uniform(random) - 1, 2 * uniform(random) - 1};
    const float squared = dot(v, v);
    if (squared > 0.01f && squared < 1) return v * (1 / std::sqrt(squared));
  }
}

/// Returns normals of a sphere (its radius in voxels), at the centres of 4x2x2 voxels around a
/// point of its surface.
Normals sphere_normals(std::mt19937& random, float radius) {
  const Vec3f center = random_direction(random) * radius;
  Normals normals;
  for (int i = 0; i < kValuesPerBlock; ++i)
    normals[static_cast<std::size_t>(i)] =
        center + Vec3f{static_cast<float>((i >> 3) * 2 + (i & 1)), static_cast<float>(i >> 1 & 1),
                       static_cast<float>(i >> 2 & 1)};
  return normals;
}

Angles sphere_angles(float radius) {
  std::mt19937 random(1);
  Angles angles;
  for (int round = 0; round < 500; ++round) {
    const Normals normals = sphere_normals(random, radius);
    const auto used = static_cast<std::uint32_t>(random() & 0xFFFFu);
    angles.add(normals, used, encode_normal_block(normals, used));
  }
  return angles;
}

/// Returns the errors for blocks with these directions, randomly distributed over the values.
Angles mixed_angles(const std::vector<Vec3f>& directions, std::mt19937& random) {
  Normals normals;
  for (Vec3f& normal : normals) normal = directions[random() % directions.size()];
  Angles angles;
  angles.add(normals, 0xFFFF, encode_normal_block(normals, 0xFFFF));
  return angles;
}

TEST(EncodeNormalBlock, NothingUsedGivesZeroBits) {
  EXPECT_EQ(encode_normal_block(Normals{}, 0), NormalBlock{});
}

TEST(EncodeNormalBlock, EqualNormalsAreExactToAThousandthOfADegree) {
  std::mt19937 random(2);
  for (int round = 0; round < 2000; ++round) {
    Normals normals;
    normals.fill(random_direction(random));
    Angles angles;
    angles.add(normals, 0x00F0, encode_normal_block(normals, 0x00F0));
    EXPECT_LT(angles.max, 0.001);
  }
}

TEST(EncodeNormalBlock, AxisAlignedNormalsAreExact) {
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {-1.0f, 1.0f}) {
      Normals normals{};
      for (Vec3f& normal : normals) normal[axis] = sign;
      EXPECT_EQ(encode_normal_block(normals, 0xFFFF).normal(5), normals[5]);
    }
}

TEST(EncodeNormalBlock, SmoothNormalsAreExactToMuchLessThanADegree) {
  // The limits are measured means and maxima, with a margin of a fifth.
  const Angles far = sphere_angles(1000), near = sphere_angles(100), close = sphere_angles(20);
  EXPECT_LT(far.mean(), 0.009);
  EXPECT_LT(near.mean(), 0.09);
  EXPECT_LT(near.max, 0.4);
  EXPECT_LT(close.mean(), 0.45);
  EXPECT_LT(close.max, 2.0);
}

TEST(EncodeNormalBlock, PointsOfAGridAreEncodedWell) {
  // All sixteen points of a grid with perpendicular axes of a few degrees.
  std::mt19937 random(3);
  Angles angles;
  double step = 0;
  for (int round = 0; round < 300; ++round) {
    const Vec3f base = random_direction(random);
    Vec3f u = cross(base, random_direction(random));
    u = u * (0.04f / std::sqrt(dot(u, u)));
    const Vec3f v = cross(base, u) * (0.4f + 0.6f * uniform(random));
    Normals normals;
    for (int i = 0; i < kValuesPerBlock; ++i)
      normals[static_cast<std::size_t>(i)] = NormalBlock::grid_point(base, u, v, i >> 2, i & 3);
    angles.add(normals, 0xFFFF, encode_normal_block(normals, 0xFFFF));
    step += degrees_between(normals[0], normals[1]);
  }
  EXPECT_LT(angles.mean(), 0.1 * step / 300);
}

TEST(EncodeNormalBlock, NormalsAlongALineGetSixteenSteps) {
  std::mt19937 random(4);
  Angles angles;
  for (int round = 0; round < 300; ++round) {
    const Vec3f base = random_direction(random);
    Vec3f side = cross(base, random_direction(random));
    side = side * (1 / std::sqrt(dot(side, side)));
    Normals normals;
    for (Vec3f& normal : normals) {
      const float angle = (uniform(random) - 0.5f) * 0.5f;
      normal = base * std::cos(angle) + side * std::sin(angle);
    }
    angles.add(normals, 0xFFFF, encode_normal_block(normals, 0xFFFF));
  }
  // Sixteen steps over half a radian: a quarter of a step is 0.45 degrees. With four steps it would
  // be 2.4.
  EXPECT_LT(angles.mean(), 0.6);
}

TEST(EncodeNormalBlock, TheSidesOfBoxesAreEncodedWell) {
  const Vec3f x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
  std::mt19937 random(5);
  for (const std::vector<Vec3f>& sides : std::vector<std::vector<Vec3f>>{
           {x, y}, {x, -x}, {-z, y}, {x, y, z}, {-x, y, -z}, {x, -x, z}})
    EXPECT_LT(mixed_angles(sides, random).max, 0.5);
}

TEST(EncodeNormalBlock, EntirelyDifferentDirectionsAreEncodedWell) {
  std::mt19937 random(6);
  double two = 0, three = 0, opposite = 0;
  for (int round = 0; round < 200; ++round) {
    const Vec3f a = random_direction(random), b = random_direction(random),
                c = random_direction(random);
    opposite += mixed_angles({a, -a}, random).mean() / 200;
    two += mixed_angles({a, b}, random).mean() / 200;
    three += mixed_angles({a, b, c}, random).mean() / 200;
  }
  // Axes have four bits: half a step is at most a fifteenth of the axis, about four degrees.
  EXPECT_LT(opposite, 0.5);
  EXPECT_LT(two, 1.0);
  EXPECT_LT(three, 3.0);
}

TEST(EncodeNormalBlock, UnusedValuesDoNotMatter) {
  std::mt19937 random(7);
  for (int round = 0; round < 200; ++round) {
    Normals normals = sphere_normals(random, 5);
    const auto used = static_cast<std::uint32_t>(random() & 0xFFFFu);
    const NormalBlock block = encode_normal_block(normals, used);
    for (std::size_t i = 0; i < normals.size(); ++i)
      if ((used >> i & 1u) == 0) normals[i] = {NAN, -7.0f, 1e30f};
    EXPECT_EQ(encode_normal_block(normals, used), block);
  }
}

TEST(EncodeNormalBlock, EarlierBlocksDoNotMatter) {
  // Blocks of one normal each. A thread caches the results of some of them. The first normals are
  // equal as numbers, but not to the bit.
  std::vector<Vec3f> directions = {{0, 0, 1},         {-0.0f, 0, 1},   {0, -0.0f, 1},
                                   {-0.0f, -0.0f, 1}, {0.6f, 0, 0.8f}, {0.6f, -0.0f, 0.8f}};
  std::mt19937 random(11);
  while (directions.size() < 300) directions.push_back(random_direction(random));
  const auto encode = [](Vec3f direction) {
    Normals normals;
    normals.fill(direction);
    return encode_normal_block(normals, 0xFFFF);
  };
  for (const Vec3f& direction : directions) {
    const NormalBlock after_others = encode(direction);
    NormalBlock alone;
    std::thread([&] { alone = encode(direction); }).join();
    EXPECT_EQ(after_others, alone);
  }
}

TEST(EncodeNormalBlock, NormalsWithoutADirectionAreIgnored) {
  std::mt19937 random(8);
  Normals normals = sphere_normals(random, 5);
  const NormalBlock block = encode_normal_block(normals, 0x7FF8);
  normals[0] = {};
  normals[1] = {NAN, 0, 0};
  normals[2] = {INFINITY, 0, 0};
  normals[15] = {0, NAN, 1};
  EXPECT_EQ(encode_normal_block(normals, 0xFFFF), block);
  EXPECT_EQ(encode_normal_block(normals, 0x8007), NormalBlock{});
}

TEST(EncodeNormalBlock, LengthsDoNotMatter) {
  std::mt19937 random(9);
  for (int round = 0; round < 50; ++round) {
    Normals normals = sphere_normals(random, 8);
    const NormalBlock block = encode_normal_block(normals, 0xFFFF);
    for (Vec3f& normal : normals) normal = normal * 0x1p40f;
    EXPECT_EQ(encode_normal_block(normals, 0xFFFF), block);
  }
}

TEST(EncodeNormalBlock, NormalsWithMoreWeightAreCloser) {
  std::mt19937 random(10);
  std::vector<float> weights(16, 1.0f);
  const NormalBlock plain = encode_normal_block(sphere_normals(random, 3), 0xFFFF, weights.data());
  random.seed(10);
  EXPECT_EQ(encode_normal_block(sphere_normals(random, 3), 0xFFFF), plain);
  weights[3] = weights[9] = 200.0f;
  Angles heavy, even;
  for (int round = 0; round < 50; ++round) {
    const Normals normals = sphere_normals(random, 3);
    heavy.add(normals, 0x0208, encode_normal_block(normals, 0xFFFF, weights.data()));
    even.add(normals, 0x0208, encode_normal_block(normals, 0xFFFF));
  }
  EXPECT_LT(heavy.mean(), even.mean() / 2);
}

TEST(EncodeNormalBlock, TheBitsAreTheSameOnEveryMachine) {
  // Computes FNV-1a over blocks of all kinds.
  std::mt19937 random(11);
  std::uint64_t hash = 0xCBF29CE484222325ull;
  for (int round = 0; round < 1000; ++round) {
    Normals normals = sphere_normals(random, round % 2 == 0 ? 3.0f : 50.0f);
    if (round % 5 == 0)
      for (std::size_t i = 0; i < normals.size(); i += 3) normals[i] = random_direction(random);
    const auto used = static_cast<std::uint32_t>(random() & 0xFFFFu);
    for (const std::uint32_t word : encode_normal_block(normals, used).words)
      hash = (hash ^ word) * 0x100000001B3ull;
  }
  EXPECT_EQ(hash, 16909430294251302497u) << "changes with the encoder, not with the machine";
}

TEST(EncodePair, LeavesAreEncodedBetterThanInnerVoxels) {
  std::mt19937 random(17);
  double leaf = 0, inner = 0;
  for (int round = 0; round < 200; ++round) {
    PairValues values;
    for (std::uint32_t i = 0; i < 12; ++i)
      values.set(i, {.color = {90, 90, 90}, .normal = random_direction(random)}, i % 6 == 0);
    NormalBlock block;
    encode_pair_normals(values, reinterpret_cast<std::uint64_t*>(block.words));
    for (int i = 0; i < 12; ++i)
      (i % 6 == 0 ? leaf : inner) += degrees_between(values.values[i].normal, block.normal(i));
  }
  EXPECT_LT(leaf / (200 * 2), 10);
  EXPECT_LT(3 * leaf / 2, inner / 10);
}

}  // namespace
}  // namespace voxdag
