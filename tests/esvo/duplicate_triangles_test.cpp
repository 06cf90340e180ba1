#include "voxdag/esvo/build/duplicate_triangles.hpp"

#include <gtest/gtest.h>
#include <time.h>

#include "support/grid_mesh.hpp"
#include "voxdag/esvo/build/build_esvo.hpp"

namespace voxdag {
namespace {

using Flags = std::vector<std::uint8_t>;

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

TEST(DuplicateTriangles, ATriangleThatStartsElsewhereIsADuplicate) {
  const TwoTriangles two;
  EXPECT_EQ(find_duplicate_triangles(two.mesh, &two.appearance), (Flags{0, 1}));
  EXPECT_EQ(find_duplicate_triangles(two.mesh, nullptr), (Flags{0, 1}));
}

TEST(DuplicateTriangles, AnotherAppearanceIsNoDuplicate) {
  TwoTriangles normal, uv, color, material;
  normal.appearance.normals[4] = {0, 1, 0};
  uv.appearance.uvs[3] = {1, 0.5f};
  color.appearance.colors[5].g = 3;
  material.mesh.triangle_materials = {0, 1};
  for (const TwoTriangles* two : {&normal, &uv, &color, &material}) {
    EXPECT_TRUE(find_duplicate_triangles(two->mesh, &two->appearance).empty());
    EXPECT_EQ(find_duplicate_triangles(two->mesh, nullptr), (Flags{0, 1}));
  }
}

TEST(DuplicateTriangles, TheOtherSideIsNoDuplicate) {
  TwoTriangles two;
  two.mesh.triangles[1] = {0, 2, 1};
  EXPECT_TRUE(find_duplicate_triangles(two.mesh, nullptr).empty());
}

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

TEST(DuplicateTriangles, AMeshOfDuplicatesIsBuiltAsOneOfEachTriangle) {
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
  const double start = cpu_seconds();
  EXPECT_EQ(build_esvo(often, grid), expected);
  // 0.1 s; 4 s if every copy were clipped.
  EXPECT_LT(cpu_seconds() - start, 1.5);
}

}  // namespace
}  // namespace voxdag
