#include "voxdag/mesh/polygon.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <string>

#include "formats/readers/mesh_text.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/formats/readers/obj/obj_reader.hpp"
#include "voxdag/formats/readers/off/off_reader.hpp"
#include "voxdag/formats/readers/ply/ply_reader.hpp"

namespace voxdag {
namespace {

using Polygon = std::vector<Vec3f>;

std::vector<Triangle> fan_of(const Polygon& polygon) {
  std::vector<Triangle> fan;
  for (std::uint32_t i = 2; i < polygon.size(); ++i) fan.push_back({0, i - 1, i});
  return fan;
}

std::vector<Triangle> cut(const Polygon& polygon) {
  std::vector<Triangle> triangles = fan_of(polygon);
  cut_polygon(triangles, polygon);
  return triangles;
}

/// Returns twice the signed area of a polygon in a plane of constant z.
double flat_area(const Polygon& polygon, const std::vector<std::uint32_t>& corners) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3d a(polygon[corners[i]]), b(polygon[corners[(i + 1) % corners.size()]]);
    sum += a.x * b.y - a.y * b.x;
  }
  return sum;
}

/// Expects triangles that tile a flat, counter-clockwise polygon. Their boundary is the polygon and
/// none is clockwise, so they cover each of its points once and no other points.
void expect_tiles(const Polygon& polygon, const std::vector<Triangle>& triangles) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  double sum = 0, whole = 0;
  for (const Triangle& t : triangles) {
    const double area = flat_area(polygon, {t[0], t[1], t[2]});
    sum += area;
    EXPECT_GE(area, -1e-9);  // rounding of corners on one line
    for (const auto& [a, b] : {std::pair(t[0], t[1]), std::pair(t[1], t[2]), std::pair(t[2], t[0])})
      a < b ? ++edges[{a, b}] : --edges[{b, a}];
  }
  std::erase_if(edges, [](const auto& edge) { return edge.second == 0; });
  EXPECT_EQ(edges.size(), polygon.size());
  for (std::uint32_t i = 0; i < polygon.size(); ++i) {
    const std::uint32_t j = i + 1 == polygon.size() ? 0 : i + 1;
    EXPECT_EQ((edges[{std::min(i, j), std::max(i, j)}]), i < j ? 1 : -1);
    whole += Vec3d(polygon[i]).x * Vec3d(polygon[j]).y - Vec3d(polygon[i]).y * Vec3d(polygon[j]).x;
  }
  EXPECT_NEAR(sum, whole, 1e-9 * std::abs(whole));
}

/// Expects that the polygon is tiled from every first corner, in counter-clockwise order.
void expect_cut_well(const Polygon& polygon) {
  Polygon turned = polygon;
  for (std::size_t first = 0; first < std::min<std::size_t>(polygon.size(), 40); ++first) {
    SCOPED_TRACE(first);
    expect_tiles(turned, cut(turned));
    std::rotate(turned.begin(), turned.begin() + 1, turned.end());
  }
}

const Polygon kDart = {{0, 0, 0}, {2, 2, 0}, {0, 1, 0}, {-2, 2, 0}};

TEST(Polygon, ConvexPolygonsKeepTheirFan) {
  Polygon circle;
  for (int i = 0; i < 60; ++i) {
    const double angle = i * std::numbers::pi / 30;
    circle.push_back({static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)),
                      static_cast<float>(0.3 * std::cos(angle) + 7)});
    EXPECT_EQ(cut(circle), fan_of(circle));
  }
  std::reverse(circle.begin(), circle.end());
  EXPECT_EQ(cut(circle), fan_of(circle));
}

TEST(Polygon, CornersOnAnEdgeOrInOnePlaceKeepTheFan) {
  for (const Polygon& polygon :
       {Polygon{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {0, 1, 0}},
        Polygon{{0, 0, 0}, {0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {2, 2, 0}, {0, 2, 0}},
        Polygon{{0, 0, 0}, {1, 0, 0.3f}, {1, 1, 0}, {0, 1, 0.3f}}})
    EXPECT_EQ(cut(polygon), fan_of(polygon));
}

TEST(Polygon, ConcaveQuadsAreCutWhereTheyBend) {
  expect_cut_well(kDart);
  const auto has_long_diagonal = [](const std::vector<Triangle>& triangles) {
    return std::any_of(triangles.begin(), triangles.end(), [](Triangle t) {
      std::sort(t.begin(), t.end());
      return t == Triangle{0, 1, 3};
    });
  };
  EXPECT_FALSE(has_long_diagonal(cut(kDart)));
  EXPECT_EQ(cut(kDart), fan_of(kDart));  // Every other corner is visible from its first corner.
  const Polygon turned{kDart[1], kDart[2], kDart[3], kDart[0]};
  EXPECT_NE(cut(turned), fan_of(turned));
}

TEST(Polygon, AnyDirectionIsSeenFromItsOwnSide) {
  const Polygon flat = {{0, 0, 0}, {4, 0, 0}, {4, 3, 0}, {3, 3, 0},
                        {3, 1, 0}, {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};
  for (const auto& [u, v] :
       {std::pair(Vec3f{1, 0, 0}, Vec3f{0, 1, 0}), std::pair(Vec3f{0, 1, 0}, Vec3f{1, 0, 0}),
        std::pair(Vec3f{0, 0, 1}, Vec3f{0, 1, 0}), std::pair(Vec3f{0, 0, -1}, Vec3f{1, 0, 0}),
        std::pair(Vec3f{0.6f, 0.8f, 0}, Vec3f{-0.4f, 0.3f, -0.86f})}) {
    Polygon tilted;
    for (const Vec3f& p : flat) tilted.push_back(u * p.x + v * p.y + Vec3f{100, -50, 20});
    expect_tiles(flat, cut(tilted));
  }
}

TEST(Polygon, StarsCombsAndSpiralsAreTiled) {
  Polygon comb{{0, 0, 0}, {60, 0, 0}}, spiral, star;
  for (int i = 29; i >= 0; --i) {
    comb.push_back({static_cast<float>(2 * i + 1.5), 10, 0});
    comb.push_back({static_cast<float>(2 * i), 1, 0});
  }
  for (int side = 0; side < 2; ++side)
    for (int i = 0; i < 100; ++i) {
      const double t = 0.2 * (side == 0 ? 100 - i : 1 + i), r = t + (side == 0 ? 1.5 : 0);
      spiral.push_back(
          {static_cast<float>(r * std::sin(t)), static_cast<float>(r * std::cos(t)), 0});
    }
  for (int i = 0; i < 50; ++i) {
    const double r = i % 2 == 0 ? 10 : 1, angle = i * std::numbers::pi / 25;
    star.push_back(
        {static_cast<float>(r * std::cos(angle)), static_cast<float>(r * std::sin(angle)), 0});
  }
  std::vector<std::uint32_t> all(spiral.size());
  std::iota(all.begin(), all.end(), 0u);
  if (flat_area(spiral, all) < 0) std::reverse(spiral.begin(), spiral.end());
  expect_cut_well(comb);
  expect_cut_well(star);
  expect_cut_well(spiral);
}

TEST(Polygon, RandomSimplePolygonsAreTiled) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int n = 4; n < 200; ++n) {
    SCOPED_TRACE(n);
    Polygon polygon;
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * (i + 0.9 * uniform(random)) / n;
      const double r = 0.05 + uniform(random);
      polygon.push_back(
          {static_cast<float>(r * std::cos(angle)), static_cast<float>(r * std::sin(angle)), 0.5f});
    }
    std::rotate(polygon.begin(), polygon.begin() + n / 3, polygon.end());
    expect_tiles(polygon, cut(polygon));
  }
}

TEST(Polygon, ABridgeToAHoleLeavesTheHoleOpen) {
  expect_cut_well({{0, 0, 0},
                   {3, 0, 0},
                   {3, 3, 0},
                   {0, 3, 0},
                   {0, 0, 0},
                   {1, 1, 0},
                   {1, 2, 0},
                   {2, 2, 0},
                   {2, 1, 0},
                   {1, 1, 0}});
}

TEST(Polygon, CrossingAndDegenerateOnesUseEveryCornerAndEnd) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> small(0, 3);
  for (int trial = 0; trial < 3000; ++trial) {
    Polygon polygon(static_cast<std::size_t>(3 + trial % 30));
    for (Vec3f& p : polygon)
      p = {static_cast<float>(small(random)), static_cast<float>(small(random)),
           static_cast<float>(trial % 3 == 0 ? small(random) : 1)};
    const std::vector<Triangle> triangles = cut(polygon);
    std::vector<int> uses(polygon.size());
    for (const Triangle& triangle : triangles)
      for (const std::uint32_t corner : triangle) ++uses.at(corner);
    EXPECT_EQ(std::count(uses.begin(), uses.end(), 0), 0);
    EXPECT_EQ(cut(polygon), triangles);
  }
}

/// Ear clipping as in polygon.cpp, but every test tries every corner.
class BruteForceClipper {
 public:
  explicit BruteForceClipper(const Polygon& points) : points_(points) {
    for (std::uint32_t i = 0; i < points.size(); ++i) {
      ring_.push_back(i);
      was_reflex_.push_back(false);
    }
  }

  std::vector<Triangle> run() {
    const std::vector<std::uint32_t> all = ring_;
    for (const std::uint32_t i : all) was_reflex_[i] = corner_area(i) <= 0;
    clip(all, 0);
    for (int leniency = 1; leniency <= 3; ++leniency)
      for (const std::uint32_t corner : all) clip({corner}, leniency);
    return triangles_;
  }

 private:
  double area(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    return flat_area(points_, {a, b, c});
  }
  std::size_t place(std::uint32_t i) const {
    return static_cast<std::size_t>(std::find(ring_.begin(), ring_.end(), i) - ring_.begin());
  }
  std::uint32_t neighbour(std::uint32_t i, int step) const {
    const std::size_t at = place(i) + ring_.size();
    return ring_.empty() ? i : ring_[(step < 0 ? at - 1 : at + 1) % ring_.size()];
  }
  double corner_area(std::uint32_t i) const { return area(neighbour(i, -1), i, neighbour(i, 1)); }

  bool is_ear(std::uint32_t i, int leniency) const {
    if (leniency == 3) return true;
    const double size = corner_area(i);
    if (size <= 0 || leniency == 2) return size >= 0;
    const std::uint32_t a = neighbour(i, -1), c = neighbour(i, 1);
    for (const std::uint32_t other : ring_) {
      const Vec3f p = points_[other];
      if (!was_reflex_[other] || corner_area(other) > 0) continue;
      if (p == points_[a] || p == points_[i] || p == points_[c]) continue;
      const double least = std::min({area(a, i, other), area(i, c, other), area(c, a, other)});
      if (leniency == 0 ? least >= 0 : least > 0) return false;
    }
    return true;
  }

  void clip(std::vector<std::uint32_t> corners, int leniency) {
    while (!corners.empty() && ring_.size() > 2) {
      std::vector<std::uint32_t> waiting;
      for (const std::uint32_t i : corners) {
        const auto is_waiting = std::find(waiting.begin(), waiting.end(), i) != waiting.end();
        if (ring_.size() <= 2 || place(i) == ring_.size() || is_waiting || !is_ear(i, leniency))
          continue;
        const std::uint32_t before = neighbour(i, -1), after = neighbour(i, 1);
        triangles_.push_back({before, i, after});
        ring_.erase(ring_.begin() + static_cast<std::ptrdiff_t>(place(i)));
        for (const std::uint32_t next : {before, after})
          if (std::find(waiting.begin(), waiting.end(), next) == waiting.end())
            waiting.push_back(next);
      }
      leniency = 0;
      corners = waiting;
    }
  }

  const Polygon& points_;
  std::vector<std::uint32_t> ring_;
  std::vector<bool> was_reflex_;
  std::vector<Triangle> triangles_;
};

TEST(Polygon, CutsTheEarsThatABruteForceClipperCuts) {
  std::mt19937 random(5);
  int compared = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    const unsigned grid = 2 + static_cast<unsigned>(trial) % 7;
    Polygon polygon(static_cast<std::size_t>(4 + trial % 25));
    for (Vec3f& p : polygon)
      p = {static_cast<float>(random() % grid), static_cast<float>(random() % grid), 1};
    std::vector<std::uint32_t> all(polygon.size());
    std::iota(all.begin(), all.end(), 0u);
    const std::vector<Triangle> triangles = cut(polygon);
    if (flat_area(polygon, all) <= 0 || triangles == fan_of(polygon)) continue;
    EXPECT_EQ(triangles, BruteForceClipper(polygon).run()) << trial;
    ++compared;
  }
  EXPECT_GT(compared, 1000);
}

/// If every test of a corner tried every other corner, these polygons would take over a minute.
TEST(Polygon, RepeatedPositionsCostNothing) {
  std::mt19937 random(7);
  Polygon polygon(200000);
  for (Vec3f& p : polygon)
    p = {static_cast<float>(random() % 3), static_cast<float>(random() % 3), 0};
  std::size_t polls = 0;
  std::vector<Triangle> triangles = fan_of(polygon);
  cut_polygon(triangles, polygon, [&] { ++polls; });
  EXPECT_LT(polls, 10u);  // one poll per million nodes
  EXPECT_NE(triangles, fan_of(polygon));
}

TEST(Polygon, CuttingCanBeStopped) {
  Polygon star;
  std::mt19937 random(9);
  for (int i = 0; i < 20000; ++i) {
    const double angle = 2 * std::numbers::pi * i / 20000;
    const double radius = 0.2 + static_cast<double>(random() % 1000) / 1000;
    star.push_back({static_cast<float>(radius * std::cos(angle)),
                    static_cast<float>(radius * std::sin(angle)), 0});
  }
  std::vector<Triangle> triangles = fan_of(star);
  EXPECT_THROW(cut_polygon(triangles, star, [] { throw Cancelled(); }), Cancelled);
}

TEST(Polygon, NotFiniteCornersKeepTheFan) {
  for (const float bad : {INFINITY, NAN}) {
    Polygon polygon{kDart[1], kDart[2], kDart[3], kDart[0], {bad, 0, 0}};
    EXPECT_EQ(cut(polygon), fan_of(polygon));
  }
  Polygon huge;
  for (const Vec3f& p : kDart) huge.push_back(p * 1e38f);
  std::rotate(huge.begin(), huge.begin() + 1, huge.end());
  EXPECT_NE(cut(huge), fan_of(huge));
}

TEST(Polygon, EveryReaderCutsConcaveFaces) {
  // A triangle, then a dart that starts at its second corner, then a triangle.
  const std::string points = "0 0 0\n2 2 0\n0 1 0\n-2 2 0\n";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nelement face 3\nproperty list uchar int vertex_indices\nend_header\n";
  std::string obj, binary = ply;
  binary.replace(binary.find("ascii"), 5, "binary_little_endian");
  for (const Vec3f& p : kDart) {
    for (int axis = 0; axis < 3; ++axis) append(binary, p[axis]);
    obj += "v " + std::to_string(p.x) + " " + std::to_string(p.y) + " 0\n";
  }
  for (const std::vector<int>& face : {std::vector{0, 1, 2}, {1, 2, 3, 0}, {0, 2, 3}}) {
    binary += static_cast<char>(face.size());
    for (const int corner : face) append(binary, corner);
  }
  const std::string faces = "3 0 1 2\n4 1 2 3 0\n3 0 2 3\n";

  std::vector<Triangle> dart{{1, 2, 3}, {1, 3, 0}};
  cut_polygon(dart, kDart);
  const StoredVector<Triangle> expected{{0, 1, 2}, dart[0], dart[1], {0, 2, 3}};
  EXPECT_EQ(read_text(read_obj, obj + "f 1 2 3\nf 2 3 4 1\nf 1 3 4\n").triangles, expected);
  EXPECT_EQ(read_text(read_obj, "f 1 2 3\nf 2 3 4 1\nf 1 3 4\n" + obj).triangles, expected);
  EXPECT_EQ(read_text(read_ply, ply + points + faces).triangles, expected);
  EXPECT_EQ(read_text(read_ply, binary).triangles, expected);
  EXPECT_EQ(read_text(read_off, "OFF\n4 3 0\n" + points + faces).triangles, expected);
}

}  // namespace
}  // namespace voxdag
