#include "voxdag/builders/pieces/surface_sum.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace voxdag {
namespace {

struct Part {
  Vec3f normal;
  float area;
};

Vec3f stored_normal(const std::vector<Part>& parts) {
  SurfaceSum sum;
  for (const Part& part : parts) sum.add({1, 1, 1}, part.normal, part.area);
  return voxel_value(sum).normal;
}

TEST(SurfaceSum, ASliverThatComesFirstDoesNotTurnTheNormal) {
  const Vec3f up{0, 0, 1}, down{0, 0, -1};
  EXPECT_GT(stored_normal({{down, 0.01f}, {up, 1}}).z, 0.99f);
  EXPECT_GT(stored_normal({{up, 1}, {down, 0.01f}}).z, 0.99f);
  EXPECT_LT(stored_normal({{up, 0.01f}, {down, 1}}).z, -0.99f);
}

TEST(SurfaceSum, TheLargerSideOfAThinVoxelDecides) {
  const Vec3f n{0.6f, 0, 0.8f};
  const Vec3f stored = stored_normal({{n, 1}, {-n, 1.2f}});
  EXPECT_LT(dot(stored, n), -0.999f);
  EXPECT_LT(dot(stored_normal({{-n, 1.2f}, {n, 1}}), n), -0.999f);
}

TEST(SurfaceSum, EqualSidesOfAThinVoxelGiveANormalThatPointsUp) {
  for (const Vec3f n : {Vec3f{0, 0, -1}, Vec3f{0.6f, 0, -0.8f}, Vec3f{-1, 0, 0}}) {
    const Vec3f a = stored_normal({{n, 1}, {-n, 1}}), b = stored_normal({{-n, 1}, {n, 1}});
    EXPECT_LT(dot(a, n), -0.999f);
    EXPECT_EQ(a, b);
  }
}

TEST(SurfaceSum, TheOrderOfSumsDoesNotMatter) {
  const std::vector<Part> parts{
      {{0, 0, 1}, 1}, {{0, 0, -1}, 0.9f}, {{1, 0, 0}, 0.2f}, {{0, 0.8f, -0.6f}, 0.3f}};
  const Vec3f reference = stored_normal(parts);
  for (std::size_t first = 1; first < parts.size(); ++first) {
    std::vector<Part> turned(parts.begin() + static_cast<std::ptrdiff_t>(first), parts.end());
    turned.insert(turned.end(), parts.begin(), parts.begin() + static_cast<std::ptrdiff_t>(first));
    EXPECT_GT(dot(stored_normal(turned), reference), 0.9999f) << first;
  }
}

TEST(SurfaceSum, ACornerOfABoxHasTheMeanOfItsFaces) {
  const Vec3f stored = stored_normal({{{1, 0, 0}, 1}, {{0, 1, 0}, 1}, {{0, 0, 1}, 1}});
  const float third = 1 / std::sqrt(3.0f);
  EXPECT_NEAR(stored.x, third, 1e-5f);
  EXPECT_NEAR(stored.y, third, 1e-5f);
  EXPECT_NEAR(stored.z, third, 1e-5f);
}

}  // namespace
}  // namespace voxdag
