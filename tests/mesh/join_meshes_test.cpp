#include "voxdag/mesh/join_meshes.hpp"

#include <gtest/gtest.h>

#include "voxdag/mesh/mesh_memory.hpp"

namespace voxdag {
namespace {

MeshWithAppearance triangle(float x, bool has_colors) {
  MeshWithAppearance source;
  source.mesh.vertices.assign({{x, 0, 0}, {x, 1, 0}, {x, 0, 1}});
  source.mesh.triangles.push_back({0, 1, 2});
  source.appearance.materials.resize(1);
  if (has_colors) source.appearance.colors.assign(3, {1, 2, 3, 65535});
  return source;
}

std::uint64_t bytes(const MeshWithAppearance& source) {
  return memory_bytes(source.mesh) + memory_bytes(source.appearance);
}

TEST(JoinMeshes, EachFileKeepsItsTrianglesMaterialsAndImages) {
  MemoryBudget memory;
  MeshWithAppearance a = triangle(0, false), b = triangle(5, true);
  b.mesh.triangle_materials.assign({1});
  b.mesh.materials = {"red", "blue"};
  b.appearance.materials.resize(2);
  b.appearance.materials[1].color_map.image = 0;
  b.appearance.images.resize(1);
  a.appearance.images.resize(2);
  b.mesh.objects = {"lid"};
  b.mesh.object_runs = {{0, 0}};
  memory.reserve(bytes(a) + bytes(b));
  name_parts(a, "a.obj", &memory);
  name_parts(b, "b.obj", &memory);
  append_mesh(a, std::move(b), &memory);
  EXPECT_EQ(a.mesh.triangles.at(1), (Triangle{3, 4, 5}));
  EXPECT_EQ(a.mesh.vertices.at(3).x, 5);
  EXPECT_EQ(a.mesh.materials, (std::vector<std::string>{"a.obj", "red", "blue"}));
  EXPECT_EQ(a.mesh.triangle_materials.at(1), 2u);
  EXPECT_EQ(a.mesh.objects, (std::vector<std::string>{"a.obj", "b.obj/lid"}));
  EXPECT_EQ(a.mesh.object_runs.at(1), (ObjectRun{1, 1}));
  ASSERT_EQ(a.appearance.materials.size(), 3u);
  EXPECT_EQ(a.appearance.materials[2].color_map.image, 2);
  ASSERT_EQ(a.appearance.colors.size(), 6u);
  EXPECT_EQ(a.appearance.colors[0], Rgba16{});
  EXPECT_EQ(a.appearance.colors[3], (Rgba16{1, 2, 3, 65535}));
  EXPECT_EQ(memory.used(), bytes(a));
}

TEST(JoinMeshes, MeshesFarFromZeroAreMeasuredFromOneOrigin) {
  MeshWithAppearance a = triangle(0, false), b = triangle(0.25, false);
  a.mesh.origin = {4649776, 0, 0};
  b.mesh.origin = {4649777, 0, 0};
  name_parts(a, "a.obj", nullptr);
  name_parts(b, "b.obj", nullptr);
  append_mesh(a, std::move(b), nullptr);
  EXPECT_EQ(a.mesh.origin, (Vec3d{4649776, 0, 0}));
  EXPECT_EQ(a.mesh.position(0), (Vec3d{4649776, 0, 0}));
  EXPECT_EQ(a.mesh.position(4), (Vec3d{4649777.25, 1, 0}));
}

TEST(JoinMeshes, IdsFollowTheRuns) {
  const std::vector<ObjectRun> runs = {{0, 2}, {1, 0}, {1, 7}, {3, 2}};
  const auto ids = ids_of_runs(runs, 5, nullptr);
  EXPECT_EQ(std::vector(ids.begin(), ids.end()), (std::vector<std::uint32_t>{2, 7, 7, 2, 2}));
}

}  // namespace
}  // namespace voxdag
