/// Tests files that a mesh file names: they must be inside its folder, and the caller gets their
/// names.
#include <gtest/gtest.h>

#include <algorithm>

#include "formats/readers/appearance_files.hpp"
#include "formats/readers/mesh_text.hpp"

namespace voxdag {
namespace {

namespace fs = std::filesystem;

/// A folder with a mesh, and a folder beside it that meshes must not read.
class NamedFilesTest : public ReadAppearance {
 protected:
  NamedFilesTest() {
    for (const char* folder : {"meshes", "meshes/textures", "secret"})
      fs::create_directory(directory_.path() / folder);
    std::string buffer;
    for (const int v : {0, 0, 0, 1, 0, 0, 0, 1, 0}) append(buffer, static_cast<float>(v));
    write("secret/b.bin", buffer);
    write("meshes/b.bin", buffer);
    write("secret/m.mtl", "newmtl m\nKd 1 0 0\n");
    write("meshes/m.mtl", "newmtl m\nKd 1 0 0\n");
  }

  /// Returns the message of the Error that reading throws, or the number of warnings.
  std::string outcome(const fs::path& file, const ReadOptions& options = {}) {
    try {
      return std::to_string(read_mesh_with_appearance(file, options).warnings.size());
    } catch (const Error& error) {
      return error.what();
    }
  }
  fs::path gltf(const std::string& buffer_uri, const std::string& extra = "") {
    return write("meshes/a.gltf", R"({"asset":{"version":"2.0"},"buffers":[{"uri":")" + buffer_uri +
                                      R"(","byteLength":36}],
          "bufferViews":[{"buffer":0,"byteLength":36}],
          "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
          "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}])" +
                                      extra + "}");
  }
  fs::path obj(const std::string& library) {
    return write("meshes/a.obj", "mtllib " + library + "\n" + kSquare + "usemtl m\nf 1 2 3\n");
  }
  std::string refused(const std::string& place, const std::string& name) {
    return path("meshes/") + place + ": '" + name + "' is outside of the folder of the mesh file";
  }
};

TEST_F(NamedFilesTest, BuffersOutsideOfTheFolderAreErrors) {
  const std::string absolute = path("secret/b.bin");
  for (const std::string& uri :
       {std::string("../secret/b.bin"), std::string("%2e%2e/secret/b.bin"),
        std::string("..%2Fsecret/b.bin"), std::string("textures/../../secret/b.bin"), absolute}) {
    const fs::path file = gltf(uri);
    EXPECT_NE(outcome(file).find("a.gltf: buffers[0]: '"), std::string::npos) << uri;
    EXPECT_TRUE(outcome(file).ends_with("is outside of the folder of the mesh file")) << uri;
    EXPECT_THROW(read_mesh(file), Error);
    EXPECT_EQ(outcome(file, {.allow_outside = true}), "0") << uri;
  }
  EXPECT_EQ(outcome(gltf("../secret/b.bin")), refused("a.gltf: buffers[0]", "../secret/b.bin"));
}

TEST_F(NamedFilesTest, LinksOutOfTheFolderAreErrors) {
  fs::create_symlink("../secret/b.bin", directory_.path() / "meshes/link.bin");
  fs::create_directory_symlink("../secret", directory_.path() / "meshes/linked");
  for (const std::string uri : {"link.bin", "linked/b.bin"}) {
    EXPECT_EQ(outcome(gltf(uri)), refused("a.gltf: buffers[0]", uri));
    EXPECT_EQ(outcome(gltf(uri), {.allow_outside = true}), "0");
  }
}

TEST_F(NamedFilesTest, NamesInsideOfTheFolderAreRead) {
  fs::create_symlink("b.bin", directory_.path() / "meshes/link.bin");
  for (const std::string& uri :
       {std::string("b.bin"), std::string("textures/../b.bin"), std::string("../meshes/b.bin"),
        std::string("link.bin"), path("meshes/b.bin")})
    EXPECT_EQ(outcome(gltf(uri)), "0") << uri;
}

TEST_F(NamedFilesTest, ImagesOutsideOfTheFolderAreErrors) {
  const fs::path file =
      gltf("b.bin", R"(,"images":[{"uri":"textures/a.png"},{"uri":"%2e%2e/secret/a.png"}])");
  EXPECT_EQ(outcome(file), refused("a.gltf: images[1]", "../secret/a.png"));
  EXPECT_EQ(outcome(file, {.allow_outside = true}), "0");
  EXPECT_NO_THROW(read_mesh(file));  // read_mesh() does not need the images.
}

TEST_F(NamedFilesTest, MtlFilesAndTheirTexturesOutsideOfTheFolderAreErrors) {
  EXPECT_EQ(outcome(obj("../secret/m.mtl")), refused("a.obj: mtllib", "../secret/m.mtl"));
  EXPECT_EQ(outcome(obj("..\\secret\\m.mtl")), refused("a.obj: mtllib", "../secret/m.mtl"));
  EXPECT_EQ(outcome(obj("m.mtl")), "0");
  write("meshes/textures/t.mtl", "newmtl m\nKd 1 1 1\nmap_Kd ../wall.png\n");
  EXPECT_EQ(outcome(obj("textures/t.mtl")), "0");
  write("meshes/textures/t.mtl", "newmtl m\nKd 1 1 1\nmap_Kd ..\\..\\secret\\wall.png\n");
  EXPECT_EQ(outcome(obj("textures/t.mtl")),
            refused("textures/t.mtl: line 3", "../../secret/wall.png"));
  EXPECT_EQ(outcome(obj("textures/t.mtl"), {.allow_outside = true}), "0");
}

TEST_F(NamedFilesTest, PlyTexturesOutsideOfTheFolderAreErrors) {
  const fs::path file = write(
      "meshes/a.ply",
      "ply\nformat ascii 1.0\ncomment TextureFile ../secret/a.png\nelement vertex 3\n"
      "property float x\nproperty float y\nproperty float z\nproperty float s\nproperty float t\n"
      "element face 1\nproperty list uchar int vertex_index\nend_header\n"
      "0 0 0 0 0\n1 0 0 0 0\n0 1 0 0 0\n3 0 1 2\n");
  EXPECT_EQ(outcome(file), refused("a.ply: comment TextureFile", "../secret/a.png"));
  EXPECT_EQ(outcome(file, {.allow_outside = true}), "0");
}

TEST_F(NamedFilesTest, TheCallerLearnsOfEveryNamedFile) {
  const auto named = [&](const fs::path& file, bool with_appearance) {
    std::vector<fs::path> files;
    const ReadOptions options{.named_files = &files};
    with_appearance ? (void)read_mesh_with_appearance(file, options)
                    : (void)read_mesh(file, options);
    for (fs::path& each : files) each = each.lexically_relative(directory_.path() / "meshes");
    std::sort(files.begin(), files.end());
    files.erase(std::unique(files.begin(), files.end()), files.end());
    return files;
  };
  using Files = std::vector<fs::path>;
  write("meshes/t.mtl", "newmtl m\nmap_Kd textures/a.png\nbump b.png\n");
  EXPECT_EQ(named(obj("t.mtl"), true), (Files{"b.png", "t.mtl", "textures/a.png"}));
  EXPECT_EQ(named(obj("t.mtl"), false), Files{"t.mtl"});
  for (const bool with_appearance : {false, true})
    EXPECT_EQ(named(gltf("b.bin", R"(,"images":[{"uri":"a%20b.png"}])"), with_appearance),
              (Files{"a b.png", "b.bin"}));
}

TEST_F(NamedFilesTest, MessagesCutLongNamesAndHaveOneLine) {
  const std::string name = "../" + std::string(5000, 'x');
  const std::string message = outcome(gltf(name));
  EXPECT_LT(message.size(), directory_.path().string().size() + 350);
  EXPECT_NE(message.find("xxx...' is outside"), std::string::npos);
  const std::string control = outcome(gltf("..\\n\\u001b[31m\\u009b/x"));
  for (const char c : control) EXPECT_GE(static_cast<unsigned char>(c), 32);
  EXPECT_NE(control.find("'..??[31m?/x'"), std::string::npos) << control;
}

}  // namespace
}  // namespace voxdag
