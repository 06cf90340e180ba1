// The topology of face meshes: watertight rectangles and two-manifolds.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "colored_scene.hpp"
#include "read_back.hpp"
#include "voxdag/formats/exports/faces/export_faces.hpp"
#include "voxdag/formats/exports/faces/manifold_faces.hpp"
#include "voxdag/formats/exports/faces/rectangles.hpp"
#include "voxdag/formats/exports/faces/shared_vertices.hpp"

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
  if (faces >= FaceMesh::kManifold)
    for_each_manifold_face(
        voxels, window, nullptr, [](std::uint64_t) {}, add, faces == FaceMesh::kSmooth);
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

/// Expects that each edge has two triangles, and each corner one fan.
void expect_manifold(const Triangles3& triangles) {
  EXPECT_EQ(edges_by_triangles(triangles).size(), 1u);
  EXPECT_EQ(edges_by_triangles(triangles).begin()->first, 2);
  expect_one_fan_each(triangles);
  EXPECT_GT(volume_of(triangles), 0);
}

TEST(FaceMeshes, ManifoldsHaveTwoTrianglesAnEdgeAndOneFanACorner) {
  for (const int count : {300, 1500, 4000}) {
    const ExportedScene scene(4, count);
    for (const Box3i& window : {whole_grid(4), Box3i{{3, 1, 6}, {13, 16, 12}}})
      for (const FaceMesh faces : {FaceMesh::kManifold, FaceMesh::kSmooth})
        expect_manifold(triangles_of(scene.view(), window, faces));
  }
}

TEST(FaceMeshes, AllVoxelsAroundACornerMakeAManifold) {
  for (unsigned mask = 1; mask < 256; ++mask) {
    std::vector<Vec3i> voxels;
    for (int i = 0; i < 8; ++i)  // Around a corner between blocks.
      if ((mask >> i & 1) != 0)
        voxels.push_back(Vec3i{3 + (i & 1), 3 + (i >> 1 & 1), 3 + (i >> 2)});
    const Svdag dag = brute_svdag(3, voxels);
    for (const FaceMesh faces : {FaceMesh::kManifold, FaceMesh::kSmooth})
      expect_manifold(triangles_of(dag.view(), whole_grid(3), faces));
  }
}

TEST(FaceMeshes, SmoothFacesStayNearTheirSquaresAndLookOutward) {
  const ExportedScene scene(4, 1500);
  for_each_manifold_face(
      scene.view(), whole_grid(4), nullptr, [](std::uint64_t) {},
      [](const FacePolygon& polygon) {
        const int axis = face_axis(polygon.face);
        Vec3d lo(polygon.voxel), hi = lo + Vec3d{1, 1, 1}, area{};
        lo[axis] = hi[axis] = lo[axis] + (static_cast<int>(polygon.face) & 1);
        for (const Vec3d corner : polygon.corners) {
          const Vec3d off = corner - max(lo, min(hi, corner));
          for (int i = 0; i < 3; ++i) EXPECT_LE(std::abs(off[i]), 0.5);
        }
        for (const auto& [a, b, c] : polygon.triangles)
          area = area + cross(polygon.corners[b] - polygon.corners[a],
                              polygon.corners[c] - polygon.corners[a]);
        EXPECT_GT(dot(area, Vec3d(face_normal(polygon.face))), 0);
      },
      true);
}

TEST(FaceMeshes, ASmoothBallIsNearerToItsSphereAndKeepsItsVolume) {
  constexpr double kRadius = 24;
  const Vec3d centre{32.3, 31.6, 32.1};
  std::vector<Vec3i> voxels;
  for (int i = 0; i < 64 * 64 * 64; ++i) {
    const Vec3i v{i % 64, i / 64 % 64, i / 4096};
    const Vec3d off = Vec3d(v) + Vec3d{0.5, 0.5, 0.5} - centre;
    if (dot(off, off) <= kRadius * kRadius) voxels.push_back(v);
  }
  const Svdag dag = brute_svdag(6, voxels);
  const auto error = [&](const Triangles3& triangles) {
    double squares = 0;
    for (const auto& t : triangles) {  // At the middles of triangles.
      Vec3d sum{};
      for (const Corner3& c : t) sum = sum + Vec3d{c[0], c[1], c[2]};
      squares += std::pow(length(sum * (1.0 / 3) - centre) - kRadius, 2);
    }
    return std::sqrt(squares / static_cast<double>(triangles.size()));
  };
  const Triangles3 cubes = triangles_of(dag.view(), whole_grid(6), FaceMesh::kManifold),
                   smooth = triangles_of(dag.view(), whole_grid(6), FaceMesh::kSmooth);
  EXPECT_LT(error(smooth), 0.5 * error(cubes));
  const auto volume = static_cast<double>(voxels.size());
  EXPECT_NEAR(volume_of(smooth), volume, 0.005 * volume);
}

TEST(FaceMeshes, ASmoothBoxIsFlatAwayFromItsEdges) {
  std::vector<Vec3i> voxels;
  for (int i = 0; i < 512; ++i) voxels.push_back({4 + i % 8, 4 + i / 8 % 8, 4 + i / 64});
  const Svdag dag = brute_svdag(4, voxels);
  for (const auto& triangle : triangles_of(dag.view(), whole_grid(4), FaceMesh::kSmooth))
    for (const Corner3& c : triangle)
      if (c[0] > 6 && c[0] < 10 && c[1] > 6 && c[1] < 10) {
        EXPECT_EQ(c[2], c[2] < 8 ? 4 : 12);
        EXPECT_EQ(c[0], std::round(c[0]));
      }
}

TEST(FaceMeshes, SharedVerticesAreThePlacesOfCorners) {
  const ExportedScene scene(5, 6000);
  for (const bool smooth : {false, true}) {
    SharedVertices vertices(true, nullptr);
    std::vector<Vec3d> places;
    std::set<Corner3> distinct;
    for_each_manifold_face(
        scene.view(), kWindow, nullptr, [](std::uint64_t) {},
        [&](const FacePolygon& polygon) {
          vertices.add(polygon);
          places.insert(places.end(), vertices.added().begin(), vertices.added().end());
          ASSERT_EQ(vertices.numbers().size(), polygon.corners.size());
          for (std::size_t i = 0; i < polygon.corners.size(); ++i) {
            const Vec3d p = polygon.corners[i];
            ASSERT_LT(vertices.numbers()[i], places.size());
            EXPECT_EQ(places[vertices.numbers()[i]], p);
            distinct.insert({p.x, p.y, p.z});
          }
        },
        smooth);
    EXPECT_EQ(distinct.size(), places.size());
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
