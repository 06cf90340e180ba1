#include "voxdag/mesh_view/corner_normals.hpp"

#include <gtest/gtest.h>

#include "meshes.hpp"
#include "voxdag/render/camera.hpp"

namespace voxdag {
namespace {

Vec3f winding_normal(const Mesh& mesh, const Triangle& triangle) {
  const Vec3f a = mesh.vertices[triangle[0]];
  return normalized(cross(mesh.vertices[triangle[1]] - a, mesh.vertices[triangle[2]] - a));
}

float distance(Vec3f a, Vec3f b) { return std::sqrt(dot(a - b, a - b)); }

TEST(PackedNormal, KeepsEveryDirection) {
  std::mt19937 random(1);
  std::normal_distribution<float> normal;
  for (int i = 0; i < 10000; ++i) {
    const Vec3f v{normal(random), normal(random), normal(random)};
    // The error is half a step of 2/65534 along both sides of the square, times a slope of up to
    // sqrt(3).
    EXPECT_LT(distance(PackedNormal(v).unpack(), normalized(v)), 8e-5f);
  }
  for (int axis = 0; axis < 3; ++axis)
    for (const float sign : {-1.0f, 1.0f}) {
      Vec3f v{};
      v[axis] = sign;
      EXPECT_EQ(PackedNormal(v).unpack(), v);
    }
  EXPECT_EQ(PackedNormal().unpack(), (Vec3f{0, 0, 1}));
}

TEST(CornerNormals, AreTheFacesOfACube) {
  const Mesh mesh = cube_mesh();
  const auto normals = corner_normals(mesh, 40);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (const PackedNormal normal : normals[t])
      EXPECT_EQ(normal.unpack(), winding_normal(mesh, mesh.triangles[t]));
}

TEST(CornerNormals, AreTheDiagonalsOfACubeWithoutCreases) {
  const Mesh mesh = cube_mesh();
  const auto normals = corner_normals(mesh, 90);
  // Weights by angle do not depend on the triangulation of the faces.
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t corner = 0; corner < 3; ++corner)
      EXPECT_LT(distance(normals[t][corner].unpack(),
                         normalized(mesh.vertices[mesh.triangles[t][corner]])),
                1e-4f);
}

TEST(CornerNormals, PointOutwardsOnASphereWhicheverWayItsTrianglesWind) {
  const Mesh mesh = disordered_sphere_mesh(24);
  const auto normals = corner_normals(mesh, 40);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Triangle& triangle = mesh.triangles[t];
    const Vec3f own = winding_normal(mesh, triangle);
    if (!(dot(own, own) > 0)) continue;  // at the poles
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const Vec3f at = mesh.vertices[triangle[corner]];
      const Vec3f outwards = at * (dot(own, at) < 0 ? -1.0f : 1.0f);
      // The mesh's rows are 7.5 degrees apart.
      EXPECT_LT(distance(normals[t][corner].unpack(), outwards), 0.02f) << t << " " << corner;
    }
  }
}

TEST(CornerNormals, ManyTrianglesAtOnePointStayFlat) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 1}};
  constexpr int kFan = 5000;
  for (int i = 0; i <= kFan; ++i) {
    const double angle = 6.283185307179586 * i / kFan;
    mesh.vertices.push_back(static_cast<Vec3f>(Vec3d{std::cos(angle), std::sin(angle), 0}));
  }
  for (std::uint32_t i = 1; i <= kFan; ++i) mesh.triangles.push_back({0, i, i + 1});
  const auto normals = corner_normals(mesh, 40);
  EXPECT_LT(distance(normals[7][0].unpack(), winding_normal(mesh, mesh.triangles[7])), 1e-4f);
}

}  // namespace
}  // namespace voxdag
