#include "voxdag/builders/pieces/duplicate_surfaces.hpp"

#include <gtest/gtest.h>

#include "support/grid_mesh.hpp"
#include "voxdag/builders/esvo/build/build_esvo.hpp"

namespace voxdag {
namespace {

using Indices = std::vector<std::size_t>;

/// Returns the triangles that repeat others.
Indices duplicates_of(const Mesh& mesh, const Appearance* appearance) {
  const IndexSet duplicates = find_duplicate_surfaces(mesh, appearance);
  Indices indices;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    if (duplicates.contains(i)) indices.push_back(i);
  return indices;
}

/// Two triangles at the same place; the second starts with another corner.
struct TwoTriangles {
  Mesh mesh;
  Appearance appearance;

  TwoTriangles() {
    mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 0}};
    mesh.triangles = {{0, 1, 2}, {1, 2, 3}};
    appearance.materials.resize(2);
    appearance.normals.assign(6, {0, 0, 1});
    appearance.uvs = {{0, 0}, {1, 0}, {0, 1}, {1, 0}, {0, 1}, {0, 0}};
    appearance.colors.resize(6);
  }
};

TEST(DuplicateSurfaces, ATriangleThatStartsElsewhereIsADuplicate) {
  const TwoTriangles two;
  EXPECT_EQ(duplicates_of(two.mesh, &two.appearance), Indices{1});
  EXPECT_EQ(duplicates_of(two.mesh, nullptr), Indices{1});
}

TEST(DuplicateSurfaces, AnotherAppearanceIsNoDuplicate) {
  TwoTriangles normal, uv, color, material;
  normal.appearance.normals[4] = {0, 1, 0};
  uv.appearance.uvs[3] = {1, 0.5f};
  color.appearance.colors[5].g = 3;
  material.mesh.triangle_materials = {0, 1};
  for (const TwoTriangles* two : {&normal, &uv, &color, &material}) {
    EXPECT_EQ(duplicates_of(two->mesh, &two->appearance), Indices{});
    EXPECT_EQ(duplicates_of(two->mesh, nullptr), Indices{1});
  }
}

TEST(DuplicateSurfaces, TheOtherSideIsNoDuplicate) {
  TwoTriangles two;
  two.mesh.triangles[1] = {0, 2, 1};
  EXPECT_EQ(duplicates_of(two.mesh, nullptr), Indices{});
}

TEST(DuplicateSurfaces, AMeshOfDuplicatesIsBuiltAsOneOfEachTriangle) {
  // A slanted wave of 200 triangles, each of them 1000 times.
  const Mesh once = test::grid_mesh(10, [](int i, int j) {
    const auto x = static_cast<float>(i), y = static_cast<float>(j);
    return Vec3f{x * 6, y * 6, 20 + 3 * x + 2 * y + 4 * std::sin(x)};
  });
  Mesh often = once;
  for (int i = 1; i < 1000; ++i)
    often.triangles.insert(often.triangles.end(), once.triangles.begin(), once.triangles.end());
  const Grid grid{6, {0, 0, 0}, 1.0, kSubvoxels};
  const Esvo expected = build_esvo(once, grid);
  EXPECT_EQ(find_duplicate_surfaces(often, nullptr).count(), 999 * once.triangles.size());
  EXPECT_EQ(build_esvo(often, grid), expected);
}

}  // namespace
}  // namespace voxdag
