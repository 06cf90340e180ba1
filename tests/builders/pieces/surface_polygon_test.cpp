// Tests polygons and the octants of their cell.
#include "voxdag/builders/pieces/surface_polygon.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace voxdag {
namespace {

TEST(SurfacePolygon, LiesInOneOctantOrTwoOrTheResultIsUnknown) {
  const auto octants = [](Vec3d a, Vec3d b, Vec3d c) {
    return SurfacePolygon::triangle(a, b, c).octants();
  };
  const auto one = octants({0.1, -0.2, 0.3}, {0.4, -0.5, 0.6}, {0.7, -0.8, 0.9});
  ASSERT_TRUE(one);
  EXPECT_EQ(one->first, 0b101u);
  EXPECT_EQ(one->last, 0b101u);
  const auto two = octants({0.1, -0.2, 0.3}, {0.4, 0.5, 0.6}, {0.7, 0, 0.9});
  ASSERT_TRUE(two);
  EXPECT_EQ(two->first, 0b101u);
  EXPECT_EQ(two->last, 0b111u);
  EXPECT_FALSE(octants({0.1, -0.2, 0.3}, {0.4, 0.5, -0.6}, {0.7, 0.8, 0.9}));
  EXPECT_FALSE(octants({1e-6, -0.2, 0.3}, {0.4, -0.5, 0.6}, {0.7, -0.8, 0.9}));
  EXPECT_FALSE(octants({0.1, 0, 0.3}, {0.4, 0.5, 0.6}, {0.7, 0.8, 0.9}));
  SurfacePolygon point;
  point.become_point({0.5, 0.5, 0.5});
  EXPECT_FALSE(point.octants());
}

TEST(SurfacePolygon, TheOctantsShareItsArea) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  const auto any = [&] {
    return Vec3d{coordinate(random), coordinate(random), coordinate(random)};
  };
  int in_two = 0;
  for (int round = 0; round < 1000; ++round) {
    const Vec3d a = any(), size = any() * 0.5;
    const auto near = [&] {
      const Vec3d by = any();
      return Vec3d{a.x + by.x * size.x, a.y + by.y * size.y, a.z + by.z * size.z};
    };
    SurfacePolygon whole = SurfacePolygon::triangle(near(), near(), near());
    whole.clip_to_cell();
    if (whole.count < 3) continue;
    const auto octants = whole.octants();
    Vec3d sum{};
    for (int child = 0; child < 8; ++child) {
      SurfacePolygon part;
      part.become_octant(whole, child, 0b111);
      // Octants are enlarged twice along each axis.
      const Vec3d area = part.area() * 0.25;
      sum = sum + area;
      if (!octants || std::sqrt(dot(area, area)) < 1e-12) continue;
      EXPECT_TRUE(static_cast<std::uint32_t>(child) == octants->first ||
                  static_cast<std::uint32_t>(child) == octants->last);
      // A cut that misses the polygon changes nothing.
      SurfacePolygon same;
      same.become_octant(whole, child, octants->first ^ octants->last);
      ASSERT_EQ(same.count, part.count);
      for (int i = 0; i < same.count; ++i) EXPECT_EQ(same.corners[i], part.corners[i]);
      in_two += octants->first != octants->last ? 1 : 0;
    }
    const Vec3d off = sum - whole.area();
    EXPECT_LT(std::sqrt(dot(off, off)), 1e-9);
  }
  EXPECT_GT(in_two, 100);
}

}  // namespace
}  // namespace voxdag
