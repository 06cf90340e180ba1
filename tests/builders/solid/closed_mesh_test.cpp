#include "voxdag/builders/solid/closed_mesh.hpp"

#include <gtest/gtest.h>

#include "bodies.hpp"

namespace voxdag {
namespace {

OddEdges odd_edges(const Mesh& mesh) {
  const Grid grid = fit_grid(mesh, 6);
  const QuantizedMesh quantized(mesh, grid);
  return find_odd_edges(quantized, {});
}

TEST(ClosedMesh, BodiesHaveNoOddEdges) {
  Mesh mesh;
  add_box(mesh, {0, 0, 0}, {1, 2, 3});
  EXPECT_EQ(odd_edges(mesh).count, 0u);
  std::mt19937 rng(1);
  add_rough_ball(mesh, {5, 5, 5}, 2, 0.5, 9, rng);
  EXPECT_EQ(odd_edges(mesh).count, 0u);
}

TEST(ClosedMesh, PointsCountAndNotIndices) {
  Mesh mesh;
  add_box(mesh, {0, 0, 0}, {1, 1, 1});
  Mesh split;
  for (const Triangle& t : mesh.triangles) {
    const auto first = static_cast<std::uint32_t>(split.vertices.size());
    for (const std::uint32_t corner : t) split.vertices.push_back(mesh.vertices[corner]);
    split.triangles.push_back({first, first + 1, first + 2});
  }
  EXPECT_EQ(odd_edges(split).count, 0u);
}

TEST(ClosedMesh, AHoleHasItsEdges) {
  Mesh mesh;
  add_box(mesh, {0, 0, 0}, {1, 1, 1});
  mesh.triangles.pop_back();
  const OddEdges odd = odd_edges(mesh);
  EXPECT_EQ(odd.count, 3u);
  EXPECT_NE(odd.a, odd.b);
  // A triangle without area closes nothing and opens nothing.
  mesh.triangles.push_back({0, 0, 1});
  EXPECT_EQ(odd_edges(mesh).count, 3u);
}

}  // namespace
}  // namespace voxdag
