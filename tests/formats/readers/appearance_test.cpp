/// Tests the appearance that mesh files describe.
#include "voxdag/mesh/appearance.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "formats/readers/appearance_files.hpp"
#include "formats/readers/mesh_text.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/image/color.hpp"

namespace voxdag {
namespace {

TEST_F(ReadAppearance, ObjCornersHaveTheirCoordinatesAndNormals) {
  const auto result = read("a.obj", kSquare +
                                        "vt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 2\nvn 3 0 0\n"
                                        "f 1/1/1 2/2/2 3/3/1\nf -4//-1 -2/-1 -1\n");
  const Appearance& a = result.appearance;
  // In the file v points up, in the library down.
  EXPECT_EQ(a.uvs, (std::vector<Vec2f>{{0, 1}, {1, 1}, {1, 0}, {}, {1, 0}, {}}));
  EXPECT_EQ(a.normals, (std::vector<Vec3f>{{0, 0, 1}, {1, 0, 0}, {0, 0, 1}, {1, 0, 0}, {}, {}}));
  EXPECT_TRUE(a.colors.empty());
  ASSERT_EQ(a.materials.size(), 1u);
  EXPECT_EQ(Appearance::material_index(result.mesh, 1), 0u);
}

TEST_F(ReadAppearance, ObjPolygonsKeepTheirCornersHoweverTheyAreCut) {
  // An arrow head, whose fan would not stay inside it. vt number i is (i / 10, 0).
  std::string text = "v 0 0 0\nv 2 1 0\nv 0 2 0\nv 0.5 1 0\n";
  for (int i = 1; i <= 4; ++i) text += "vt 0." + std::to_string(i) + " 0\n";
  for (const char* face : {"f 1/1 2/2 3/3 4/4\n", "f 2/2 3/3 4/4 1/1\n", "f 3/3 4/4 1/1 2/2\n"}) {
    const auto result = read("a.obj", text + face);
    ASSERT_EQ(result.mesh.triangles.size(), 2u);
    for (std::size_t c = 0; c < 6; ++c)
      EXPECT_FLOAT_EQ(result.appearance.uvs[c].x,
                      static_cast<float>(result.mesh.triangles[c / 3][c % 3] + 1) / 10);
  }
}

TEST_F(ReadAppearance, ObjFilesOfManyChunksKeepTheirPlaces) {
  std::string text;
  constexpr int kCount = 60'000;
  for (int i = 0; i < kCount; ++i) {
    const std::string n = std::to_string(i);
    text += "v " + n + " 0 0\nv " + n + " 1 0\nv " + n + " 0 1\nvt 0." + n + " 0.5\n";
    text += i % 2 == 0
                ? "f -3/-1 -2/-1 -1/-1\n"
                : "f " + std::to_string(3 * i + 1) + "/" + std::to_string(i + 1) + " -2 -1\n";
  }
  const auto result = read("a.obj", text);
  ASSERT_EQ(result.appearance.uvs.size(), 3u * kCount);
  for (int i = 0; i < kCount; ++i)
    EXPECT_EQ(result.appearance.uvs[static_cast<std::size_t>(3 * i)],
              (Vec2f{std::stof("0." + std::to_string(i)), 0.5f}));
}

TEST_F(ReadAppearance, ObjVerticesMayHaveColours) {
  const auto result = read("a.obj", "v 0 0 0 1 0.5 0\nv 1 0 0 0 0 0\nv 0 1 0 1 1 1\nf 1 2 3\n");
  ASSERT_EQ(result.appearance.colors.size(), 3u);
  expect_near(result.appearance.colors[0].color(), {1, srgb_to_linear(0.5f), 0});
  EXPECT_EQ(result.appearance.colors[2], Rgba16{});
  EXPECT_EQ(result.appearance.materials[0].base_color, (Vec3f{1, 1, 1}));
}

TEST_F(ReadAppearance, ObjVerticesWithoutColoursKeepThatOfTheirMaterial) {
  write("a.mtl", "newmtl red\nKd 1 0 0\nnewmtl both\nKd 0 1 0\n");
  const auto result = read("a.obj", "mtllib a.mtl\n" + kSquare +
                                        "v 0 0 1 0 0 1\nv 1 0 1 0 0 1\nv 0 1 1 0 0 1\nusemtl red\n"
                                        "f 1 2 3\nusemtl both\nf 5 6 7\nf 1 2 5\n");
  const Appearance& a = result.appearance;
  EXPECT_EQ(a.materials[0].base_color, (Vec3f{1, 0, 0}));
  EXPECT_EQ(a.materials[1].base_color, (Vec3f{1, 1, 1}));
  const Rgba16 blue{0, 0, 65535, 65535}, green{0, 65535, 0, 65535};
  EXPECT_EQ(a.colors, (std::vector<Rgba16>{{}, {}, {}, blue, blue, blue, green, green, blue}));
}

TEST_F(ReadAppearance, ColoursMayBeNumbersUpTo255) {
  const auto obj = read_mesh_with_appearance(
      write("a.obj", "v 0 0 0 255 127.5 0\nv 1 0 0 1 0 0\nv 0 1 0 255 255 255\nf 1 2 3\n"));
  const auto ply = read_mesh_with_appearance(
      write("a.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
            "property float z\nproperty float red\nproperty double green\n"
            "property float blue\nelement face 1\nproperty list uchar int vertex_index\n"
            "end_header\n0 0 0 255 127.5 0\n1 0 0 1 0 0\n0 1 0 255 255 255\n3 0 1 2\n"));
  for (const auto& read : {obj, ply}) {
    EXPECT_EQ(read.warnings.size(), 1u);
    expect_near(read.appearance.colors[0].color(), {1, srgb_to_linear(0.5f), 0});
    expect_near(read.appearance.colors[1].color(), {srgb_to_linear(1.0f / 255), 0, 0});
    EXPECT_EQ(read.appearance.colors[2], Rgba16{});
  }
}

TEST_F(ReadAppearance, ReferencesToNothingAreAWarning) {
  const auto result =
      read_mesh_with_appearance(write("a.obj", kSquare + "vt 1 1\nf 1/1 2/2 3/-7\n"));
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_NE(result.warnings[0].find("2 corners of faces name"), std::string::npos);
  EXPECT_EQ(result.appearance.uvs, (std::vector<Vec2f>{{1, 0}, {}, {}}));
}

TEST_F(ReadAppearance, FormatsWithoutAppearanceAreGrey) {
  const auto result = read("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_TRUE(result.appearance.normals.empty());
  ASSERT_EQ(result.appearance.materials.size(), 1u);
  expect_near(result.appearance.materials[0].base_color,
              {srgb_to_linear(0.8f), srgb_to_linear(0.8f), srgb_to_linear(0.8f)});
}

TEST_F(ReadAppearance, TheMeshEqualsTheOneOfReadMesh) {
  const char* scenes = std::getenv("VOXDAG_SCENES");
  if (scenes == nullptr) GTEST_SKIP() << "VOXDAG_SCENES is not set";
  for (const char* name :
       {"crytek_sponza/sponza.obj", "sibenik/sibenik.obj", "game_maps/zdm2.obj",
        "flight_helmet/FlightHelmet.gltf", "kitchen/kitchen.ply", "recast/dungeon.obj"}) {
    const auto file = std::filesystem::path(scenes) / name;
    if (!std::filesystem::exists(file)) continue;
    const MeshWithAppearance result = read_mesh_with_appearance(file);
    EXPECT_TRUE(result.mesh == read_mesh(file)) << name;
    const Appearance& a = result.appearance;
    const std::size_t corners = 3 * result.mesh.triangles.size();
    EXPECT_TRUE(a.normals.empty() || a.normals.size() == corners);
    EXPECT_TRUE(a.uvs.empty() || a.uvs.size() == corners);
    EXPECT_EQ(a.materials.size(), std::max<std::size_t>(result.mesh.materials.size(), 1));
    // Normals agree with the triangles nearly everywhere.
    std::size_t against = 0;
    for (std::size_t c = 0; c < a.normals.size(); ++c) {
      const Triangle& t = result.mesh.triangles[c / 3];
      const Vec3f p = result.mesh.vertices[t[0]];
      const Vec3f n = cross(result.mesh.vertices[t[1]] - p, result.mesh.vertices[t[2]] - p);
      against += dot(n, a.normals[c]) < 0;
    }
    EXPECT_LE(against, corners / 50) << name;
  }
}

/// Makes a folder the current folder while the object lives.
class CurrentFolder {
 public:
  explicit CurrentFolder(const std::filesystem::path& folder) {
    std::filesystem::current_path(folder);
  }
  ~CurrentFolder() { std::filesystem::current_path(before_); }

 private:
  std::filesystem::path before_ = std::filesystem::current_path();
};

TEST_F(ReadAppearance, AMissingTextureOfAMeshInTheCurrentFolderIsAWarning) {
  write("a.obj", "mtllib m.mtl\n" + kSquare + "vt 0 0\nusemtl m\nf 1/1 2/1 3/1\n");
  write("m.mtl", "newmtl m\nmap_Kd missing.png\n");
  const CurrentFolder folder(directory_.path());
  const MeshWithAppearance result = read_mesh_with_appearance("a.obj");
  ASSERT_EQ(result.appearance.images.size(), 1u);
  EXPECT_EQ(result.appearance.images[0].path, "missing.png");
}

}  // namespace
}  // namespace voxdag
