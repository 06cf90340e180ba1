/// Tests files that a mesh file names: they must be inside its folder, and the caller gets their
/// names.
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

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
  for (const std::string& uri :
       {std::string("../secret/b.bin"), std::string("%2e%2e/secret/b.bin"),
        std::string("..%2Fsecret/b.bin"), std::string("textures/../../secret/b.bin")}) {
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

TEST_F(NamedFilesTest, AnAbsoluteBufferIsTheOneOfItsNameBesideTheMesh) {
  for (const std::string& uri :
       {path("secret/b.bin"), std::string("C:\\\\x\\\\B.bin"), std::string("file:///c:/x/b.bin")}) {
    EXPECT_EQ(outcome(gltf(uri)), "1") << uri;
    std::vector<fs::path> named;
    read_mesh(gltf(uri), {.named_files = &named});
    EXPECT_EQ(named, std::vector{directory_.path() / "meshes/b.bin"});
  }
  fs::remove(directory_.path() / "meshes/b.bin");
  EXPECT_EQ(outcome(gltf(path("secret/b.bin"))),
            refused("a.gltf: buffers[0]", path("secret/b.bin")));
  EXPECT_EQ(outcome(gltf("http://b.bin")), path("meshes/a.gltf") +
                                               ": buffers[0]: 'http://b.bin' is not a file beside "
                                               "the mesh");
}

/// Returns the only warning of reading a file.
std::string only_warning(const fs::path& file) {
  const std::vector<std::string> warnings = read_mesh_with_appearance(file).warnings;
  EXPECT_EQ(warnings.size(), 1u);
  return warnings.empty() ? "" : warnings[0];
}

TEST_F(NamedFilesTest, ImagesOutsideOfTheFolderAreWarnings) {
  const fs::path file =
      gltf("b.bin", R"(,"images":[{"uri":"textures/a.png"},{"uri":"%2e%2e/secret/a.png"}])");
  EXPECT_EQ(only_warning(file),
            refused("a.gltf: images[1]", "../secret/a.png") + ": the image is ignored");
  EXPECT_EQ(outcome(file, {.allow_outside = true}), "0");
  EXPECT_NO_THROW(read_mesh(file));  // read_mesh() does not need the images.
}

TEST_F(NamedFilesTest, MtlFilesAndTheirTexturesOutsideOfTheFolderAreWarnings) {
  write("secret/other.mtl", "newmtl m\nKd 1 0 0\n");
  const auto result = read_mesh_with_appearance(obj("../secret/other.mtl"));
  EXPECT_EQ(result.warnings, std::vector{refused("a.obj: mtllib", "../secret/other.mtl") +
                                         ": its materials are grey"});
  EXPECT_EQ(result.appearance.materials[0].base_color, kDefaultColor);
  EXPECT_EQ(outcome(obj("m.mtl")), "0");
  write("meshes/textures/t.mtl", "newmtl m\nKd 1 1 1\nmap_Kd ../wall.png\n");
  EXPECT_EQ(outcome(obj("textures/t.mtl")), "0");
  write("meshes/textures/t.mtl", "newmtl m\nKd 1 1 1\nmap_Kd ..\\..\\secret\\wall.png\n");
  EXPECT_EQ(
      only_warning(obj("textures/t.mtl")),
      path("meshes/textures/t.mtl") +
          ": line 3: 'map_Kd ..\\..\\secret\\wall.png': '..\\..\\secret\\wall.png' is outside of "
          "the folder of the mesh file: the material's colour replaces the texture");
  EXPECT_EQ(outcome(obj("textures/t.mtl"), {.allow_outside = true}), "0");
}

TEST_F(NamedFilesTest, NamesOfOtherSystemsStandForFilesOfTheFolder) {
  write("meshes/textures/Wood.PNG", "");
  write("meshes/my wood.png", "");
  const fs::path in_textures = directory_.path() / "meshes/textures/Wood.PNG",
                 beside = directory_.path() / "meshes/my wood.png";
  // The name, the file, and whether the name has another folder.
  const std::vector<std::tuple<std::string, fs::path, bool>> names = {
      {"textures\\wood.png", in_textures, false},
      {"TEXTURES/wood.png", in_textures, false},
      {"\"my wood.png\"", beside, false},
      {"My Wood.png", beside, false},
      {"/home/someone/my wood.png", beside, true},
      {"C:\\Users\\someone\\MY WOOD.png", beside, true},
      {"../other/my wood.png", beside, true},
      {"file:///C:/x/my wood.png", beside, true}};
  for (const auto& [name, file, is_elsewhere] : names) {
    write("meshes/m.mtl", "newmtl m\nmap_Kd " + name + "\n");
    std::string uri = name;
    for (std::size_t at = 0; (at = uri.find('\\', at)) != uri.npos; at += 2)
      uri.insert(at, 1, '\\');
    for (std::size_t at = 0; (at = uri.find('"', at)) != uri.npos; at += 2) uri.insert(at, 1, '\\');
    for (const fs::path& mesh :
         {obj("m.mtl"), gltf("b.bin", R"(,"images":[{"uri":")" + uri + "\"}]")}) {
      const auto result = read_mesh_with_appearance(mesh);
      ASSERT_EQ(result.appearance.images.size(), 1u) << name;
      EXPECT_EQ(result.appearance.images[0].path, file) << name;
      EXPECT_EQ(result.warnings.size(), is_elsewhere ? 1u : 0u) << name;
    }
  }
  EXPECT_EQ(outcome(obj("D:\\my models\\M.mtl")), "1");
  EXPECT_EQ(outcome(obj("/home/someone/m.mtl")), "1");
}

TEST_F(NamedFilesTest, PlyTexturesOutsideOfTheFolderAreWarnings) {
  const fs::path file = write(
      "meshes/a.ply",
      "ply\nformat ascii 1.0\ncomment TextureFile ../secret/a.png\nelement vertex 3\n"
      "property float x\nproperty float y\nproperty float z\nproperty float s\nproperty float t\n"
      "element face 1\nproperty list uchar int vertex_index\nend_header\n"
      "0 0 0 0 0\n1 0 0 0 0\n0 1 0 0 0\n3 0 1 2\n");
  EXPECT_EQ(only_warning(file),
            refused("a.ply: comment TextureFile", "../secret/a.png") + ": the texture is ignored");
  EXPECT_EQ(outcome(file, {.allow_outside = true}), "0");
  write("meshes/A.png", "");
  EXPECT_EQ(outcome(file), "1");
  EXPECT_EQ(read_mesh_with_appearance(file).appearance.images[0].path,
            directory_.path() / "meshes/A.png");
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

TEST_F(NamedFilesTest, UrisMayBeNamesAsTheyStandOrHaveAQuery) {
  std::string buffer;
  for (const int v : {0, 0, 0, 1, 0, 0, 0, 1, 0}) append(buffer, static_cast<float>(v));
  write("meshes/my%20b.bin", buffer);
  write("meshes/a#b?.bin", buffer);
  for (const char* uri : {"my%20b.bin", "b.bin?v=3", "b.bin#part", "a#b?.bin", "a%23b%3F.bin"})
    EXPECT_EQ(outcome(gltf(uri)), "0") << uri;
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

TEST_F(NamedFilesTest, TheLongestEndOfAPathThatExistsCounts) {
  fs::create_directory(directory_.path() / "meshes/other");
  for (const char* file : {"textures/t.png", "other/t.png", "only.png", "t\xC3\xBCr.png"})
    write(std::string("meshes/") + file, "");
  const auto image_of = [&](const std::string& name) {
    write("meshes/m.mtl", "newmtl m\nmap_Kd " + name + "\n");
    const auto images = read_mesh_with_appearance(obj("m.mtl")).appearance.images;
    return images.empty() ? ""
                          : fs::relative(images[0].path, directory_.path() / "meshes").string();
  };
  EXPECT_EQ(image_of("C:\\proj\\textures\\t.png"), "textures/t.png");
  EXPECT_EQ(image_of("..\\Textures\\T.PNG"), "textures/t.png");
  EXPECT_EQ(image_of("/home/x/other/t.png"), "other/t.png");
  EXPECT_EQ(image_of("a/b/c/d/e/f/g/h/i/j/k/other/t.png"), "other/t.png");
  EXPECT_EQ(image_of("C:\\textures\\only.png"), "only.png");
  EXPECT_EQ(image_of("t\xFCr.png"), "t\xC3\xBCr.png");
  EXPECT_EQ(image_of("C:\\proj\\none.png"), "none.png");
  EXPECT_EQ(image_of("C:\\secret\\..\\..\\secret\\m.mtl"), "m.mtl");  // Not the one outside.
}

}  // namespace
}  // namespace voxdag
