#include "voxdag/formats/scenes/ply_writer.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

std::string written(const Mesh& mesh) {
  const auto path =
      std::filesystem::temp_directory_path() / ("voxdag_" + std::to_string(::getpid()) + ".ply");
  write_ply(path, mesh);
  std::ifstream in(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(in), {}};
  std::filesystem::remove(path);
  return bytes;
}

Mesh one_triangle() {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 0.5f, -2}};
  mesh.triangles = {{0, 1, 2}};
  return mesh;
}

TEST(PlyWriter, BytesAreHeaderVerticesAndFaces) {
  const Mesh mesh = one_triangle();
  const std::string bytes = written(mesh);
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float "
      "y\nproperty float z\nelement face 1\nproperty list uchar uint vertex_indices\nend_header\n";
  ASSERT_EQ(bytes.size(), header.size() + 36 + 13);
  EXPECT_EQ(bytes.substr(0, header.size()), header);
  EXPECT_EQ(std::memcmp(bytes.data() + header.size(), mesh.vertices.data(), 36), 0);
  EXPECT_EQ(bytes[header.size() + 36], 3);
  EXPECT_EQ(std::memcmp(bytes.data() + header.size() + 37, mesh.triangles.data(), 12), 0);
}

TEST(PlyWriter, MaterialsAreNamedInCommentsAndGivenPerFace) {
  Mesh mesh = one_triangle();
  mesh.materials = {"stone", "red\ncloth"};
  mesh.triangle_materials = {1};
  const std::string bytes = written(mesh);
  EXPECT_NE(bytes.find("comment material 0 stone\ncomment material 1 red cloth\n"),
            std::string::npos);
  EXPECT_NE(bytes.find("property uint material_index\nend_header\n"), std::string::npos);
  EXPECT_EQ(bytes.substr(bytes.size() - 4), std::string("\1\0\0\0", 4));
}

TEST(PlyWriter, AnUnwritablePathIsAnError) {
  EXPECT_THROW(write_ply("/no/such/directory/a.ply", one_triangle()), Error);
}

}  // namespace
}  // namespace voxdag
