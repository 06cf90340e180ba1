#include "voxdag/builders/voxelize/overlap.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "support/random_triangles.hpp"

namespace voxdag {
namespace {

// An independent reference: clips the triangle to the cube in exact rationals and tests what
// remains.
struct Rational3 {
  Int128 x, y, z, w;  // the point (x, y, z) / w, w > 0
  Int128 operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
};

Int128 common(Int128 a, Int128 b) {
  if (a < 0) a = -a;
  if (b < 0) b = -b;
  while (b != 0) {
    const Int128 r = a % b;
    a = b;
    b = r;
  }
  return a;
}

Rational3 reduced(Rational3 p) {
  const Int128 g = common(common(p.x, p.y), common(p.z, p.w));
  return g > 1 ? Rational3{p.x / g, p.y / g, p.z / g, p.w / g} : p;
}

/// Returns the part with sign * p[axis] >= sign * limit. Vertices on the boundary stay.
std::vector<Rational3> clip(const std::vector<Rational3>& polygon, int axis, int sign,
                            Int128 limit) {
  std::vector<Rational3> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Rational3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const Int128 fa = sign * (a[axis] - limit * a.w), fb = sign * (b[axis] - limit * b.w);
    if (fa >= 0) kept.push_back(a);
    if ((fa >= 0) == (fb >= 0) || fa == 0 || fb == 0) continue;
    // a + (b - a) * s with s = da / (da - db), da = fa / a.w, db = fb / b.w.
    const Int128 ka = -fb, kb = fa;  // weights of a and b over w: (a*ka + b*kb) / (a.w*ka + b.w*kb)
    Rational3 p{a.x * ka + b.x * kb, a.y * ka + b.y * kb, a.z * ka + b.z * kb, a.w * ka + b.w * kb};
    if (p.w < 0) p = {-p.x, -p.y, -p.z, -p.w};
    kept.push_back(reduced(p));
  }
  return kept;
}

/// Returns whether the clipped polygon has a point with every coordinate below `hi`. It is convex.
/// So it has one if each axis has a vertex below `hi`: the mean of these vertices.
bool reference_overlaps(const QuantizedTriangle& t, Vec3i lo, int size) {
  std::vector<Rational3> polygon;
  for (int corner = 0; corner < 3; ++corner)
    polygon.push_back({t[corner].x, t[corner].y, t[corner].z, 1});
  for (int axis = 0; axis < 3; ++axis) {
    polygon = clip(polygon, axis, 1, lo[axis]);
    polygon = clip(polygon, axis, -1, lo[axis] + size);
  }
  if (polygon.empty()) return false;
  for (int axis = 0; axis < 3; ++axis) {
    bool below = false;
    for (const Rational3& p : polygon) below |= p[axis] < (lo[axis] + size) * p.w;
    if (!below) return false;
  }
  return true;
}

TEST(TriangleOverlapsCube, AgreesWithRationalClipping) {
  // Small grids, so that the rationals of repeated clipping fit in 128 bits.
  std::mt19937_64 random(7);
  int covered = 0;
  for (int round = 0; round < 20000; ++round) {
    const int levels = 2 + static_cast<int>(random() % 2);
    const QuantizedTriangle t = random_triangle(random, levels);
    for (int i = 0; i < 40; ++i) {
      // A cell near a vertex, or any.
      Vec3i cell = t[static_cast<int>(random() % 3)];
      for (int axis = 0; axis < 3; ++axis) {
        cell[axis] = i % 4 == 0 ? static_cast<std::int32_t>(random() & 15)
                                : (cell[axis] >> 8) + static_cast<std::int32_t>(random() % 3) - 1;
        cell[axis] &= (1 << levels) - 1;
      }
      const Vec3i lo{cell.x * kSubvoxels, cell.y * kSubvoxels, cell.z * kSubvoxels};
      const bool expected = reference_overlaps(t, lo, kSubvoxels);
      ASSERT_EQ(triangle_overlaps_cube(t.x, t.y, t.z, static_cast<Vec3l>(lo), kSubvoxels), expected)
          << "round " << round;
      covered += expected ? 1 : 0;
    }
  }
  EXPECT_GT(covered, 20000);
}

TEST(TriangleOverlapsCube, TheFarFacesDoNotBelongToTheCube) {
  const Vec3l cube{0, 0, 0};
  const auto point = [&](Vec3i p) { return triangle_overlaps_cube(p, p, p, cube, 256); };
  EXPECT_TRUE(point({0, 0, 0}));
  EXPECT_TRUE(point({255, 255, 255}));
  EXPECT_FALSE(point({256, 0, 0}));
  EXPECT_FALSE(point({0, 256, 0}));
  EXPECT_FALSE(point({0, 0, 256}));
  EXPECT_FALSE(point({-1, 0, 0}));
}

TEST(TriangleOverlapsCube, AWallOnAVoxelFaceIsOneVoxelThick) {
  const Vec3i a{256, 0, 0}, b{256, 1024, 0}, c{256, 0, 1024};
  EXPECT_FALSE(triangle_overlaps_cube(a, b, c, {0, 0, 0}, 256));
  EXPECT_TRUE(triangle_overlaps_cube(a, b, c, {256, 0, 0}, 256));
}

TEST(TriangleOverlapsCube, ADiagonalPlaneThroughCornersMissesTheCubesItTouchesAtFarCorners) {
  // The plane x + y = 512: cube (0,0) reaches it only at its far edge, which is not part of the
  // cube.
  const Vec3i a{512, 0, 0}, b{0, 512, 0}, c{0, 512, 1024};
  EXPECT_FALSE(triangle_overlaps_cube(a, b, c, {0, 0, 0}, 256));
  EXPECT_TRUE(triangle_overlaps_cube(a, b, c, {256, 0, 0}, 256));
  EXPECT_TRUE(triangle_overlaps_cube(a, b, c, {0, 256, 0}, 256));
  EXPECT_TRUE(triangle_overlaps_cube(a, b, c, {256, 256, 0}, 256));
}

}  // namespace
}  // namespace voxdag
