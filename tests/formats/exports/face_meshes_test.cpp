// The topology of face meshes: watertight rectangles and two-manifolds.
#include <gtest/gtest.h>

#include <map>

#include "colored_scene.hpp"
#include "read_back.hpp"
#include "voxdag/formats/exports/faces/export_faces.hpp"
#include "voxdag/formats/exports/faces/manifold_faces.hpp"
#include "voxdag/formats/exports/faces/rectangles.hpp"

namespace voxdag {
namespace {

using Corner3 = std::array<double, 3>;
using Triangles3 = std::vector<std::array<Corner3, 3>>;

/// Returns the numbers of triangles that edges have; expects as many in each direction.
std::map<int, int> edges_by_triangles(const Triangles3& triangles) {
  std::map<std::pair<Corner3, Corner3>, int> edges;
  for (const auto& t : triangles)
    for (std::size_t c = 0; c < 3; ++c) ++edges[{t[c], t[(c + 1) % 3]}];
  std::map<int, int> counts;
  for (const auto& [edge, count] : edges) {
    const auto back = edges.find({edge.second, edge.first});
    EXPECT_EQ(back == edges.end() ? 0 : back->second, count);
    ++counts[2 * count];
  }
  return counts;
}

/// Expects that the triangles of each corner form one fan.
void expect_one_fan_each(const Triangles3& triangles) {
  std::map<Corner3, std::map<Corner3, Corner3>> next;  // Around a corner.
  for (const auto& t : triangles)
    for (std::size_t c = 0; c < 3; ++c) next[t[c]][t[(c + 1) % 3]] = t[(c + 2) % 3];
  for (const auto& [corner, ring] : next) {
    Corner3 at = ring.begin()->first;
    std::size_t steps = 0;
    do {
      at = ring.at(at);
      ++steps;
    } while (at != ring.begin()->first && steps <= ring.size());
    EXPECT_EQ(steps, ring.size());
  }
}

double volume_of(const Triangles3& triangles) {
  double volume = 0;
  for (const auto& [a, b, c] : triangles)
    volume +=
        dot(Vec3d{a[0], a[1], a[2]}, cross(Vec3d{b[0], b[1], b[2]}, Vec3d{c[0], c[1], c[2]})) / 6;
  return volume;
}

Triangles3 triangles_of(const VoxelSet& voxels, const Box3i& window, FaceMesh faces) {
  Triangles3 triangles;
  const auto add = [&](const FacePolygon& polygon) {
    for (const auto& corners : polygon.triangles) {
      auto& triangle = triangles.emplace_back();
      for (std::size_t c = 0; c < 3; ++c) {
        const Vec3d p = polygon.corners[corners[c]];
        triangle[c] = {p.x, p.y, p.z};
      }
    }
  };
  FacePolygon polygon;
  if (faces == FaceMesh::kManifold)
    for_each_manifold_face(
        voxels, window, nullptr, [](std::uint64_t) {}, add);
  else
    for_each_rectangle(voxels, window, nullptr, true, nullptr, [&](const FaceRectangle& r) {
      set_cut_rectangle(r, polygon);
      add(polygon);
    });
  return triangles;
}

TEST(FaceMeshes, WatertightRectanglesHaveNoCornersInsideEdges) {
  for (const int count : {40, 3000}) {
    const ExportedScene scene(5, count);
    for (const Box3i& window : {whole_grid(5), kWindow}) {
      const Triangles3 triangles = triangles_of(scene.view(), window, FaceMesh::kWatertight);
      for (const auto& [uses, edges] : edges_by_triangles(triangles)) EXPECT_EQ(uses % 2, 0);
      std::uint64_t voxels = 0;
      for (const auto& [x, y, z] : scene.set) voxels += is_inside({x, y, z}, window) ? 1 : 0;
      EXPECT_NEAR(volume_of(triangles), static_cast<double>(voxels), 1e-6);
      for (const auto& t : triangles) {  // None is degenerate.
        Vec3d p[3];
        for (std::size_t c = 0; c < 3; ++c) p[c] = {t[c][0], t[c][1], t[c][2]};
        EXPECT_GE(length(cross(p[1] - p[0], p[2] - p[0])), 1);
      }
    }
  }
}

TEST(FaceMeshes, ManifoldsHaveTwoTrianglesAnEdgeAndOneFanACorner) {
  for (const int count : {300, 1500, 4000}) {
    const ExportedScene scene(4, count);
    for (const Box3i& window : {whole_grid(4), Box3i{{3, 1, 6}, {13, 16, 12}}}) {
      const Triangles3 triangles = triangles_of(scene.view(), window, FaceMesh::kManifold);
      EXPECT_EQ(edges_by_triangles(triangles).size(), 1u);
      EXPECT_EQ(edges_by_triangles(triangles).begin()->first, 2);
      expect_one_fan_each(triangles);
      EXPECT_GT(volume_of(triangles), 0);
    }
  }
}

TEST(FaceMeshes, AManifoldOfVoxelsThatShareFacesStaysOnTheLattice) {
  const Svdag dag = brute_svdag(3, {{1, 1, 1}, {2, 1, 1}, {2, 2, 1}});
  for (const auto& triangle : triangles_of(dag.view(), whole_grid(3), FaceMesh::kManifold))
    for (const Corner3& corner : triangle)
      for (const double c : corner) EXPECT_EQ(c, std::round(c));
}

}  // namespace
}  // namespace voxdag
