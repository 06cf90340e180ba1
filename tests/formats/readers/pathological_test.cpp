/// Runs the reader over a directory of files that were made, or found, to break readers. The files
/// are not part of the project: the environment variable VOXDAG_SCENES names the directory that has
/// them in pathological/. pathological_expectations.txt has the expected result of each.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <set>

#include "voxdag/core/error.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"

namespace voxdag {
namespace {

namespace fs = std::filesystem;

struct Expectation {
  std::string outcome;  ///< "accept" or "refuse".
  std::string reason;   ///< Part of the message of a refusal.
};

std::map<std::string, Expectation> load_expectations() {
  std::ifstream in(VOXDAG_EXPECTATIONS);
  std::map<std::string, Expectation> expectations;
  std::string line;
  while (std::getline(in, line)) {
    if (line.empty() || line[0] == '#') continue;
    const std::size_t first = line.find('\t'), second = line.find('\t', first + 1);
    expectations[line.substr(first + 1, second - first - 1)] = {
        line.substr(0, first), second == line.npos ? "" : line.substr(second + 1)};
  }
  return expectations;
}

void expect_sound(const Mesh& mesh) {
  ASSERT_FALSE(mesh.triangles.empty());
  for (const Triangle& triangle : mesh.triangles)
    for (const std::uint32_t index : triangle) {
      ASSERT_LT(index, mesh.vertices.size());
      const Vec3f p = mesh.vertices[index];
      ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    }
  for (const std::uint32_t material : mesh.triangle_materials)
    ASSERT_LT(material, mesh.materials.size());
}

/// Expects that the attributes of a readable mesh are read or left out, whatever is wrong with
/// them.
void expect_appearance(const Mesh& mesh, const fs::path& path) {
  const MeshWithAppearance result = read_mesh_with_appearance(path);
  // Compares bits, because an unused vertex may be NaN.
  ASSERT_EQ(result.mesh.vertices.size(), mesh.vertices.size());
  EXPECT_EQ(result.mesh.triangles, mesh.triangles);
  EXPECT_EQ(result.mesh.triangle_materials, mesh.triangle_materials);
  EXPECT_EQ(result.mesh.materials, mesh.materials);
  const Appearance& a = result.appearance;
  const std::size_t corners = 3 * mesh.triangles.size();
  for (const std::size_t size : {a.normals.size(), a.uvs.size(), a.colors.size()})
    EXPECT_TRUE(size == 0 || size == corners);
  EXPECT_EQ(a.materials.size(), std::max<std::size_t>(mesh.materials.size(), 1));
  for (const Vec2f uv : a.uvs) EXPECT_TRUE(std::isfinite(uv.x) && std::isfinite(uv.y));
  for (const Vec3f n : a.normals) EXPECT_NEAR(dot(n, n), dot(n, n) > 0 ? 1 : 0, 1e-3f);
}

TEST(PathologicalMeshes, EachIsReadOrRefusedAsExpected) {
  const char* scenes = std::getenv("VOXDAG_SCENES");
  if (scenes == nullptr || !fs::is_directory(fs::path(scenes) / "pathological"))
    GTEST_SKIP() << "VOXDAG_SCENES names no directory with pathological/";
  const fs::path root = fs::path(scenes) / "pathological";
  const auto expectations = load_expectations();
  std::set<std::string> seen;
  for (const auto& entry : fs::recursive_directory_iterator(root)) {
    if (!entry.is_regular_file()) continue;
    const std::string name = fs::relative(entry.path(), root).generic_string();
    SCOPED_TRACE(name);
    std::string outcome = "accept", message;
    try {
      const Mesh mesh = read_mesh(entry.path());
      expect_sound(mesh);
      expect_appearance(mesh, entry.path());
    } catch (const Error& error) {
      outcome = "refuse";
      message = error.what();
      EXPECT_EQ(message.find('\n'), message.npos);
      EXPECT_EQ(error.file(), entry.path().string());
    }
    const auto found = expectations.find(name);
    if (found == expectations.end()) {
      ADD_FAILURE() << "no expectation; got\n" << outcome << '\t' << name << '\t' << message;
      continue;
    }
    seen.insert(name);
    EXPECT_EQ(outcome, found->second.outcome) << message;
    EXPECT_NE(message.find(found->second.reason), message.npos) << message;
  }
  for (const auto& [name, expectation] : expectations)
    EXPECT_TRUE(seen.contains(name)) << name << " is not there";
}

}  // namespace
}  // namespace voxdag
