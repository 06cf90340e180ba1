#include "voxdag/builders/esvo/shape/near_surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "support/triangle_distance.hpp"
#include "voxdag/core/morton.hpp"

namespace voxdag {
namespace {

/// A surface in [-1,1]³. Triangles outside are left out, those across its sides are clipped.
struct Surface {
  std::vector<SurfacePolygon> polygons;

  void add(Vec3d a, Vec3d b, Vec3d c) {
    polygons.push_back(SurfacePolygon::triangle(a, b, c));
    polygons.back().clip_to_cell();
    if (dot(polygons.back().area(), polygons.back().area()) < 1e-20) polygons.pop_back();
  }
  std::vector<PlanarPolygon> planar() const {
    std::vector<PlanarPolygon> result;
    for (const SurfacePolygon& polygon : polygons) {
      const Vec3d area = polygon.area();
      result.push_back({&polygon, static_cast<Vec3f>(area * (1 / std::sqrt(dot(area, area))))});
    }
    return result;
  }
};

/// Returns the graph of `height` over [-1,1]², as 2 * n² triangles, without the squares for which
/// is_hole(i, j) is true.
template <class Height, class IsHole>
Surface graph(int n, const Height& height, const IsHole& is_hole) {
  const auto at = [&](int i, int j) {
    const double x = 2.0 * i / n - 1, y = 2.0 * j / n - 1;
    return Vec3d{x, y, height(x, y)};
  };
  Surface surface;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      if (is_hole(i, j)) continue;
      surface.add(at(i, j), at(i + 1, j), at(i, j + 1));
      surface.add(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    }
  return surface;
}

/// Returns the part of [-1,1]³ between the planes z = lo + x * slope and z = hi + x * slope.
ConvexPolyhedron slab(float lo, float hi, float slope) {
  ConvexPolyhedron below, part;
  below.become_part(ConvexPolyhedron::cube(), {-slope, 0, 1}, hi);
  part.become_part(below, {slope, 0, -1}, -lo);
  return part;
}

/// Tests every point against every polygon, in double precision.
class BruteForce {
 public:
  BruteForce(const Surface& surface, double distance) : surface_(surface), distance_(distance) {}

  /// False if a point is so near to the limit that rounding decides.
  bool is_certain = true;

  bool has_near(const ConvexPolyhedron& shape, Vec3d centre = {}, double half = 1) {
    if (shape.is_empty()) return true;
    Vec3d sum{};
    for (int i = 0; i < shape.vertex_count(); ++i) {
      const auto vertex = static_cast<Vec3d>(shape.vertex(i));
      sum = sum + vertex;
      if (!is_near(centre + vertex * half)) return false;
    }
    if (!is_near(centre + sum * (half / shape.vertex_count()))) return false;
    if (small_polygons(centre, half) <= 24 || half <= 2 * distance_) return true;
    for (int child = 0; child < 8; ++child) {
      const auto direction = static_cast<Vec3d>(child_offset(child) * 2 - Vec3i{1, 1, 1});
      if (!has_near(shape.octant(child), centre + direction * (half / 2), half / 2)) return false;
    }
    return true;
  }

 private:
  bool is_near(Vec3d p) {
    double least = HUGE_VAL;
    for (const SurfacePolygon& polygon : surface_.polygons)
      for (int i = 2; i < polygon.count; ++i)
        least =
            std::min(least, test::distance_to_triangle(p, polygon.corners[0],
                                                       polygon.corners[i - 1], polygon.corners[i]));
    is_certain &= std::fabs(least - distance_) > 1e-5;
    return least <= distance_;
  }
  /// Counts the polygons within the distance of a cube that are smaller than the cube.
  int small_polygons(Vec3d centre, double half) const {
    int count = 0;
    for (const SurfacePolygon& polygon : surface_.polygons) {
      bool meets = true, is_small = true;
      for (int axis = 0; axis < 3; ++axis) {
        double lo = HUGE_VAL, hi = -HUGE_VAL;
        for (int i = 0; i < polygon.count; ++i) {
          lo = std::min(lo, polygon.corners[i][axis]);
          hi = std::max(hi, polygon.corners[i][axis]);
        }
        meets &= lo <= centre[axis] + half + distance_ && hi >= centre[axis] - half - distance_;
        is_small &= hi - lo < 2 * half;
      }
      count += meets && is_small ? 1 : 0;
    }
    return count;
  }

  const Surface& surface_;
  const double distance_;
};

TEST(NearSurface, AnswersLikeBruteForceForFewAndManyPolygons) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0, 1);
  int near[2] = {0, 0}, far[2] = {0, 0};
  for (int trial = 0; trial < 800; ++trial) {
    const int n = 1 + static_cast<int>(random() % (trial % 2 == 0 ? 3 : 12));
    const float slope = 1.5f * unit(random) - 0.75f, at = 0.6f * unit(random) - 0.3f,
                thickness = 0.15f * unit(random), bumps = 0.1f * unit(random) * unit(random);
    const unsigned seed = static_cast<unsigned>(random());
    const unsigned holes = random() % 3 == 0 ? static_cast<unsigned>(n * n) / 2 + 1 : ~0u;
    const Surface surface = graph(
        n,
        [&](double x, double y) {
          return static_cast<double>(at) + static_cast<double>(slope) * x +
                 static_cast<double>(bumps) * std::sin(9 * x + seed % 100) * std::cos(7 * y);
        },
        [&](int i, int j) {
          return (static_cast<unsigned>(i * n + j) * 2654435761u + seed) % holes == 0;
        });
    if (surface.polygons.empty()) continue;
    const ConvexPolyhedron shape = slab(at - thickness, at + thickness, slope);
    const float distance = 0.3f * unit(random) + 0.01f;
    BruteForce expected(surface, static_cast<double>(distance));
    const bool is_near = expected.has_near(shape);
    if (!expected.is_certain) continue;
    EXPECT_EQ(is_near_surface(shape, surface.planar(), distance), is_near) << trial;
    ++(is_near ? near : far)[surface.polygons.size() > 24 ? 1 : 0];
  }
  for (const int count : {near[0], near[1], far[0], far[1]}) EXPECT_GT(count, 50);
}

TEST(NearSurface, AFinelyTriangulatedWallIsNear) {
  const auto wall = graph(
      64, [](double x, double) { return 0.25 * x; }, [](int, int) { return false; });
  EXPECT_TRUE(is_near_surface(slab(-0.01f, 0.01f, 0.25f), wall.planar(), 0.02f));
  EXPECT_FALSE(is_near_surface(slab(-0.01f, 0.03f, 0.25f), wall.planar(), 0.02f));
  EXPECT_FALSE(is_near_surface(ConvexPolyhedron::cube(), wall.planar(), 0.02f));
}

TEST(NearSurface, AHoleBesideTheCentreOfAFineWallIsNotOverlooked) {
  // No corner of the wall's shape is near the hole, and neither is its centre.
  const auto wall = graph(
      64, [](double, double) { return 0.0; },
      [](int i, int j) { return i >= 40 && i < 46 && j >= 12 && j < 18; });
  EXPECT_FALSE(is_near_surface(slab(-0.01f, 0.01f, 0), wall.planar(), 0.02f));
  EXPECT_TRUE(is_near_surface(slab(-0.01f, 0.01f, 0), wall.planar(), 0.2f));
}

TEST(NearSurface, ManyPolygonsAtOnePointEnd) {
  Surface surface;
  for (int i = 0; i < 100; ++i) {
    surface.polygons.emplace_back();
    surface.polygons.back().become_point({0.3, 0.1, -0.2});
  }
  std::vector<PlanarPolygon> points;
  for (const SurfacePolygon& polygon : surface.polygons) points.push_back({&polygon, {}});
  EXPECT_TRUE(is_near_surface(ConvexPolyhedron::cube(), points, 4));
  EXPECT_FALSE(is_near_surface(ConvexPolyhedron::cube(), points, 0.01f));
}

}  // namespace
}  // namespace voxdag
