#include "voxdag/mesh/displace/displaced_triangles.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <random>
#include <set>
#include <tuple>

#include "support/displaced_crate.hpp"
#include "voxdag/builders/esvo/build/build_esvo.hpp"
#include "voxdag/builders/esvo/build/check_esvo.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/stored/esvo/validate_esvo.hpp"

namespace voxdag {
namespace {

const Box3d kEverywhere{{-1e9, -1e9, -1e9}, {1e9, 1e9, 1e9}};

std::vector<MicroTriangle> tessellate(const DisplacedTriangles& triangles, const Mesh& mesh,
                                      double limit, const Box3d& region = kEverywhere) {
  std::vector<MicroTriangle> all;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    triangles.tessellate(t, region, limit, [&](const MicroTriangle& m) { all.push_back(m); });
  return all;
}

/// Returns the number of directed edges of micro triangles without an opposite edge.
std::size_t open_edges(const std::vector<MicroTriangle>& all) {
  using Point = std::tuple<double, double, double>;
  const auto key = [](Vec3d p) { return Point{p.x, p.y, p.z}; };
  std::map<std::pair<Point, Point>, int> edges;
  for (const MicroTriangle& m : all)
    for (std::size_t i = 0; i < 3; ++i) {
      const Point a = key(m.positions[i]), b = key(m.positions[(i + 1) % 3]);
      if (a < b)
        ++edges[{a, b}];
      else
        --edges[{b, a}];
    }
  std::size_t open = 0;
  for (const auto& [edge, balance] : edges) open += balance != 0 && edge.first != edge.second;
  return open;
}

TEST(DisplacedTriangles, NeighboursOfDifferentMappingLeaveNoCracks) {
  const Crate crate;
  for (const double box_size : {0.0, 0.7}) {
    const DisplacedTriangles triangles(
        crate.mesh, crate.appearance,
        displace_all(crate.mesh, crate.appearance, stones(), 0.1, box_size));
    const auto all = tessellate(triangles, crate.mesh, 0.07);
    EXPECT_GT(all.size(), 5000u);
    EXPECT_EQ(open_edges(all), 0u);
  }
}

TEST(DisplacedTriangles, EdgesAtASurfaceThatIsNotDisplacedStay) {
  Crate crate;
  crate.mesh.triangle_materials[0] = crate.mesh.triangle_materials[1] = 1;
  auto displacements = displace_all(crate.mesh, crate.appearance, stones(), 0.1);
  displacements[1] = {};
  const DisplacedTriangles triangles(crate.mesh, crate.appearance, displacements);
  EXPECT_FALSE(triangles.is_displaced(0));
  std::size_t moved = 0, stayed = 0;
  for (const MicroTriangle& m : tessellate(triangles, crate.mesh, 0.07))
    for (const Vec3d p : m.positions) {
      // The face x = 0 is not displaced.
      const bool is_on_its_rim = p.x == 0 && (p.y == 0 || p.y == 1.5 || p.z == 0 || p.z == 1.25);
      stayed += is_on_its_rim;
      moved += p.x < 0;
    }
  EXPECT_EQ(moved, 0u);
  EXPECT_GT(stayed, 100u);
}

TEST(DisplacedTriangles, RegionsGiveTheSameMicroTrianglesAsTheWhole) {
  const Crate crate;
  const DisplacedTriangles triangles(crate.mesh, crate.appearance,
                                     displace_all(crate.mesh, crate.appearance, stones(), 0.15));
  const auto key = [](const MicroTriangle& m) {
    std::array<double, 9> k;
    for (std::size_t i = 0; i < 9; ++i) k[i] = m.positions[i / 3][static_cast<int>(i % 3)];
    return k;
  };
  std::set<std::array<double, 9>> whole, parts;
  for (const MicroTriangle& m : tessellate(triangles, crate.mesh, 0.1)) whole.insert(key(m));
  constexpr int kParts = 5;
  for (int i = 0; i < kParts * kParts * kParts; ++i) {
    const Vec3d lo{-1 + i % kParts * 0.8, -1 + i / kParts % kParts * 0.8,
                   -1 + i / kParts / kParts * 0.8};
    for (const MicroTriangle& m :
         tessellate(triangles, crate.mesh, 0.1, {lo, lo + Vec3d{0.8, 0.8, 0.8}}))
      parts.insert(key(m));
  }
  EXPECT_EQ(whole, parts);
}

TEST(DisplacedTriangles, BoundsHoldEveryMicroTriangle) {
  Crate crate;
  // Normals that turn over each face.
  for (std::size_t t = 0; t < crate.mesh.triangles.size(); ++t)
    for (const std::uint32_t v : crate.mesh.triangles[t]) {
      const Vec3f d = crate.mesh.vertices[v] - Vec3f{1, 0.75f, 0.625f};
      crate.appearance.normals.push_back(d * (1 / std::sqrt(dot(d, d))));
    }
  for (const double box_size : {0.0, 0.5}) {
    const DisplacedTriangles triangles(
        crate.mesh, crate.appearance,
        displace_all(crate.mesh, crate.appearance, stones(), -0.2, box_size));
    for (std::uint32_t t = 0; t < crate.mesh.triangles.size(); ++t) {
      const Box3d box = triangles.displaced_bounds(t);
      triangles.tessellate(t, kEverywhere, 0.05, [&](const MicroTriangle& m) {
        for (const Vec3d p : m.positions)
          for (int axis = 0; axis < 3; ++axis) {
            EXPECT_GE(p[axis], box.lo[axis]);
            EXPECT_LE(p[axis], box.hi[axis]);
          }
      });
    }
  }
}

TEST(DisplacedTriangles, PointsOfAPlaneMoveByTheirHeight) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  Appearance appearance;
  appearance.materials.resize(1);
  appearance.uvs = {{0, 1}, {1, 1}, {1, 0}, {0, 1}, {1, 0}, {0, 0}};
  const DisplacedTriangles triangles(mesh, appearance,
                                     displace_all(mesh, appearance, stones(), 0.1));
  // Edges are shorter than half a texel, so heights are those of the texture.
  for (const MicroTriangle& m : tessellate(triangles, mesh, 0.005))
    for (const Vec3d p : m.positions) {
      const Vec2f uv{static_cast<float>(p.x), static_cast<float>(1 - p.y)};
      EXPECT_NEAR(p.z, 0.1 * static_cast<double>(stones()->sample(0, uv)[0]) / 65535, 1e-5);
    }
}

TEST(DisplacedTriangles, EdgesAreNotLongerThanTheLimit) {
  const Crate crate;
  const DisplacedTriangles triangles(crate.mesh, crate.appearance,
                                     displace_all(crate.mesh, crate.appearance, stones(), 0));
  for (std::uint32_t t = 0; t < crate.mesh.triangles.size(); ++t)
    triangles.tessellate(t, kEverywhere, 0.3, [&](const MicroTriangle& m) {
      EXPECT_EQ(m.barycentrics[1], (Vec2f{1, 0}));  // An amount of 0 displaces nothing.
    });
  const DisplacedTriangles little(crate.mesh, crate.appearance,
                                  displace_all(crate.mesh, crate.appearance, stones(), 1e-9));
  for (const MicroTriangle& m : tessellate(little, crate.mesh, 0.3))
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d d = m.positions[i] - m.positions[(i + 1) % 3];
      EXPECT_LE(std::sqrt(dot(d, d)), 0.3 + 1e-8);
    }
}

TEST(Displacement, AmountsMuchLargerThanTheMeshAreRefused) {
  Crate crate;
  crate.appearance.images = {{"h.png", "h.png", {}}};
  Material& material = crate.appearance.materials[0];
  material.displacement_map.image = 0;
  material.displacement_gain = 1e30f;
  std::vector<std::string> warnings;
  for (const Displacement& d : load_displacements(crate.mesh, crate.appearance, warnings))
    EXPECT_FALSE(d.moves());
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_TRUE(warnings[0].starts_with("h.png: a displacement by 1e+30 units is too large"))
      << warnings[0];
  EXPECT_THROW(displace_all(crate.mesh, crate.appearance, stones(), -1e30), Error);
}

TEST(DisplacedTriangles, BarycentricsNameThePlaceInTheBaseTriangle) {
  const Crate crate;
  const DisplacedTriangles triangles(crate.mesh, crate.appearance,
                                     displace_all(crate.mesh, crate.appearance, stones(), 1e-9));
  for (std::uint32_t t = 0; t < crate.mesh.triangles.size(); ++t)
    triangles.tessellate(t, kEverywhere, 0.1, [&](const MicroTriangle& m) {
      const Triangle& base = crate.mesh.triangles[t];
      for (std::size_t i = 0; i < 3; ++i) {
        const Vec2f b = m.barycentrics[i];
        const Vec3f p = crate.mesh.vertices[base[0]] * (1 - b.x - b.y) +
                        crate.mesh.vertices[base[1]] * b.x + crate.mesh.vertices[base[2]] * b.y;
        const Vec3d d = Vec3d(p) - m.positions[i];
        EXPECT_LT(dot(d, d), 1e-12);
      }
    });
}

TEST(DisplacedTriangles, OctreesEncloseTheTessellatedSurface) {
  const Crate crate;
  const DisplacedTriangles triangles(crate.mesh, crate.appearance,
                                     {{stones(), -0.1, 0.3, {}, 0}, Displacement{}});
  Grid grid;
  grid.origin = {-1, -1, -1};
  grid.levels = 8;
  grid.voxel_size = 4.0 / 256;
  grid.quantization_scale = kSubvoxels / grid.voxel_size;
  EsvoMemory memory;
  const EsvoResult result = build_esvo(crate.mesh, grid, {}, nullptr, &triangles, memory);
  const std::vector<std::uint64_t> slots = memory.take();

  // Rounded as the builder does; floats hold these positions exactly.
  Mesh micro;
  for (const MicroTriangle& m :
       tessellate(triangles, crate.mesh, std::sqrt(2.0) * grid.voxel_size)) {
    const auto first = static_cast<std::uint32_t>(micro.vertices.size());
    for (const Vec3d& p : m.positions)
      micro.vertices.push_back(static_cast<Vec3f>(
          grid.to_world(static_cast<Vec3d>(*quantize(grid, p)) * (1.0 / kSubvoxels))));
    micro.triangles.push_back({first, first + 1, first + 2});
  }
  const EsvoView esvo{slots.data(), slots.size(), result.root, 8};
  const EnclosureCheck check =
      check_enclosure(esvo, {micro, grid}, grid, nullptr, nullptr, 4 * micro.triangles.size());
  EXPECT_GT(check.points, micro.triangles.size());
  EXPECT_FALSE(check.outside);

  // Checks with the displacement itself, and checks that a different displacement is noticed.
  const QuantizedMesh crate_in_grid(crate.mesh, grid);
  const EnclosureCheck own =
      check_enclosure(esvo, crate_in_grid, grid, nullptr, &triangles, 20'000);
  EXPECT_GT(own.points, 15'000u);
  EXPECT_FALSE(own.outside);
  const DisplacedTriangles deeper(crate.mesh, crate.appearance,
                                  {{stones(), -0.2, 0.3, {}, 0}, Displacement{}});
  EXPECT_TRUE(check_enclosure(esvo, crate_in_grid, grid, nullptr, &deeper, 20'000).outside);
}

TEST(DisplacedTriangles, AMicroTriangleIsFoundByItsPlace) {
  const Crate crate;
  const DisplacedTriangles triangles(crate.mesh, crate.appearance,
                                     {{stones(), -0.1, 0.3, {}, 0}, Displacement{}});
  const Box3d all{{-10, -10, -10}, {10, 10, 10}};
  for (std::uint32_t triangle = 0; triangle < crate.mesh.triangles.size(); ++triangle) {
    if (!triangles.is_displaced(triangle)) continue;
    triangles.tessellate(triangle, all, 0.1, [&](const MicroTriangle& m) {
      const Vec2f place = (m.barycentrics[0] + m.barycentrics[1] + m.barycentrics[2]) * (1.0f / 3);
      const MicroTriangle found = triangles.micro_at(triangle, place, 0.1);
      EXPECT_EQ(found.positions, m.positions);
      EXPECT_EQ(found.barycentrics, m.barycentrics);
    });
  }
}

TEST(DisplacedTriangles, GridsThatContainAPartOfTheSurfaceAreBuilt) {
  const Crate crate;
  const DisplacedTriangles triangles(crate.mesh, crate.appearance,
                                     {{stones(), -0.1, 0.3, {}, 0}, Displacement{}});
  std::mt19937 random(9);
  const auto place = [&](double lo, double hi) {
    return lo + (hi - lo) * static_cast<double>(random()) / 4294967296.0;
  };
  // Grids that reach into the topmost stones of a side. Some cells meet the bounds of the heights,
  // but not the surface.
  int with_voxels = 0;
  for (int round = 0; round < 12; ++round) {
    Grid grid;
    for (int axis = 0; axis < 3; ++axis) grid.origin[axis] = place(0, 1);
    constexpr Vec3d kSize{2, 1.5, 1.25};
    grid.origin[round % 3] = kSize[round % 3] - place(0, 0.04);
    grid.levels = 7;
    grid.voxel_size = 0.4 / 128;
    grid.quantization_scale = kSubvoxels / grid.voxel_size;
    EsvoMemory memory;
    EsvoResult result = build_esvo(crate.mesh, grid, {}, nullptr, &triangles, memory);
    const std::vector<std::uint64_t> slots = memory.take();
    const EsvoView esvo{slots.data(), slots.size(), result.root, grid.levels};
    EXPECT_EQ(validate_esvo(esvo, result.directory), result.counts) << "round " << round;
    const EnclosureCheck check =
        check_enclosure(esvo, QuantizedMesh(crate.mesh, grid), grid, nullptr, &triangles, 500);
    EXPECT_FALSE(check.outside) << "round " << round;
    with_voxels += esvo.is_empty() ? 0 : 1;
  }
  EXPECT_GT(with_voxels, 4);
}

}  // namespace
}  // namespace voxdag
