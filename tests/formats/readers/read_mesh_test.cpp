#include "voxdag/formats/readers/read_mesh.hpp"

#include <sys/stat.h>

#include <fstream>

#include "formats/readers/mesh_text.hpp"
#include "support/temp_dir.hpp"
#include "support/with_threads.hpp"
#include "voxdag/core/parallel/thread_count.hpp"
#include "voxdag/formats/readers/obj/obj_reader.hpp"
#include "voxdag/formats/readers/ply/ply_reader.hpp"
#include "voxdag/formats/readers/stl/stl_reader.hpp"

namespace voxdag {
namespace {

const std::string kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::string kPly =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const std::string kStl =
    "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
    "endloop\nendfacet\nendsolid s\n";
const std::string kOff = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

class ReadMesh : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& bytes) {
    const auto path = directory_.path() / name;
    std::ofstream(path, std::ios::binary) << bytes;
    return path;
  }
  std::string refused(const std::filesystem::path& path) {
    try {
      read_mesh(path);
    } catch (const Error& error) {
      EXPECT_EQ(error.file(), path.string());
      return error.place().text() + (error.place().empty() ? "" : ": ") + error.reason();
    }
    return "accepted";
  }
  TempDir directory_;
};

TEST_F(ReadMesh, ContentDecidesWhereItIsCertain) {
  for (const std::string name : {"a.ply", "a.obj", "a.xyz", "a"}) {
    EXPECT_EQ(read_mesh(write(name, kPly)).triangles.size(), 1u) << name;
  }
  std::string binary(84 + 50, '\0');
  binary[80] = 1;
  binary[84 + 27] = binary[84 + 43] = '\x40';  // 2 0 0 and 0 2 0
  for (const std::string name : {"a.stl", "a.STL", "a.obj", "a.ply", "a.xyz", "a"})
    for (const std::string& bytes : {kStl, binary})
      EXPECT_EQ(read_mesh(write(name, bytes)).triangles.size(), 1u) << name;
  for (const std::string name : {"a.off", "a.obj", "a"})
    EXPECT_EQ(read_mesh(write(name, kOff)).triangles.size(), 1u) << name;
  EXPECT_EQ(read_mesh(write("a.OBJ", kObj)).triangles.size(), 1u);
}

TEST_F(ReadMesh, TheCustomsAreThoseOfTheContent) {
  EXPECT_EQ(mesh_custom(write("a.obj", kObj)).up, 1);
  EXPECT_EQ(mesh_custom(write("a.obj", kStl)).up, 2);
  EXPECT_EQ(mesh_custom(write("a.ply", kPly)).up, 1);
  for (const auto& [root, unit] : {std::pair{"<amf unit=\"inch\">", "in"},
                                   {"<amf version='1' unit='meter'>", "m"},
                                   {"<amf>", "mm"},
                                   {"<amf unit=\"micron\">", ""}}) {
    const FormatCustom custom = mesh_custom(write("a.amf", root));
    EXPECT_EQ(custom.unit, unit);
    EXPECT_EQ(custom.up, 2);
  }
}

TEST_F(ReadMesh, GltfFindsItsBufferBesideIt) {
  std::string buffer;
  for (const int v : {0, 0, 0, 1, 0, 0, 0, 1, 0}) append(buffer, static_cast<float>(v));
  write("my buffer.bin", buffer);
  const auto path =
      write("a.gltf",
            R"({"asset":{"version":"2.0"},"buffers":[{"uri":"my%20buffer.bin","byteLength":36}],
          "bufferViews":[{"buffer":0,"byteLength":36}],
          "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"}],
          "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]})");
  EXPECT_EQ(read_mesh(path).vertices[1], (Vec3f{1, 0, 0}));
  write("my buffer.bin", "short");
  EXPECT_EQ(refused(path), "buffers[0]: buffer of 5 bytes, but 36 are declared");
  std::filesystem::remove(directory_.path() / "my buffer.bin");
  EXPECT_EQ(refused(path),
            "buffers[0]: buffer 'my buffer.bin': cannot open: No such file or directory");
}

TEST_F(ReadMesh, WhatIsNoFileIsRefused) {
  EXPECT_EQ(refused(directory_.path() / "none.obj"), "cannot open: No such file or directory");
  EXPECT_EQ(refused(directory_.path()), "is a directory");
  const auto pipe = directory_.path() / "pipe.obj";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(refused(pipe), "is not a regular file");
  // Another file that assimp opens.
  ASSERT_EQ(::mkfifo((directory_.path() / "pipe.lwo").c_str(), 0600), 0);
  EXPECT_NE(
      refused(write("a.lws", "LWSC\n3\n\nFirstFrame 0\nLastFrame 1\n\nLoadObject pipe.lwo\n")),
      "accepted");
  EXPECT_EQ(refused("/dev/zero"), "is not a regular file");
  EXPECT_EQ(refused(write("empty.ply", "")), "the file is empty");
}

TEST_F(ReadMesh, WhatIsNoMeshIsRefused) {
  EXPECT_EQ(refused(write("a.obj", std::string(5000, '\x7F'))),
            "OBJ without faces: there is no surface to read");
  EXPECT_EQ(refused(write("a.ply", kObj)), "line 1: not a PLY file: it does not start with 'ply'");
  EXPECT_EQ(refused(write("a.glb", kObj)), "byte 0: not glTF: the JSON is malformed here");
  EXPECT_NE(refused(write("a.xyz", kObj)), "accepted");
}

TEST_F(ReadMesh, CancellingStopsIt) {
  Progress progress;
  progress.cancel();
  EXPECT_THROW(read_mesh(write("a.obj", kObj), {&progress}), Cancelled);
  EXPECT_THROW(read_mesh(write("a.ply", kPly), {&progress}), Cancelled);
  EXPECT_THROW(read_mesh(write("a.stl", kStl), {&progress}), Cancelled);
}

TEST_F(ReadMesh, TheNumberOfThreadsChangesNothing) {
  std::string obj, ply_rows, ply_faces, stl = "solid\n";
  constexpr int kSide = 300;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const std::string point =
          std::to_string(x) + ".125 " + std::to_string(y) + " 0." + std::to_string(x * y);
      obj += "v " + point + "\n";
      ply_rows += point + "\n";
      if (x == 0 || y == 0) continue;
      if (x % 50 == 1) obj.append("usemtl m").append(std::to_string(x / 50)).append("\n");
      obj += "f -1 -2 " + std::to_string(y * kSide + x - kSide) + "\n";
      const int i = y * kSide + x;
      ply_faces.append("3 ").append(std::to_string(i)).append(" ");
      ply_faces += std::to_string(i - 1) + " " + std::to_string(i - kSide) + "\n";
      stl += "facet normal 0 0 1 outer loop\n";
      for (const int corner : {i, i - 1, i - kSide})
        stl.append("vertex ")
            .append(std::to_string(corner % kSide))
            .append(" ")
            .append(std::to_string(corner / kSide))
            .append(" 0.1\n");
      stl += "endloop endfacet\n";
    }
  std::string ply = "ply\nformat ascii 1.0\nelement vertex " + std::to_string(kSide * kSide);
  ply += "\nproperty float x\nproperty float y\nproperty float z\nelement face ";
  ply += std::to_string((kSide - 1) * (kSide - 1));
  ply += "\nproperty list uchar int vertex_indices\nend_header\n" + ply_rows + ply_faces;
  stl += "endsolid\n";
  const auto read_with = [](int threads, const Reader& reader, const std::string& text) {
    const ThreadLimit limit(static_cast<std::size_t>(threads));
    return with_threads(threads, [&] { return read_text(reader, text); });
  };
  for (const auto& [reader, text] :
       {std::pair<Reader, const std::string&>{read_obj, obj}, {read_ply, ply}, {read_stl, stl}}) {
    const Mesh alone = read_with(1, reader, text);
    EXPECT_EQ(alone.triangles.size(), std::size_t{kSide - 1} * (kSide - 1));
    for (const int threads : {2, 7}) EXPECT_TRUE(read_with(threads, reader, text) == alone);
  }
}

}  // namespace
}  // namespace voxdag
