#include "voxdag/formats/readers/mesh_chunks.hpp"

#include <random>

#include "formats/readers/mesh_text.hpp"
#include "support/error_of.hpp"
#include "support/mesh_files.hpp"
#include "support/open_count.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"

namespace voxdag {
namespace {

constexpr std::size_t kChunkSizes[] = {1, 7, 50, 64, 333, 4096, kChunkBytes};

/// Reads all chunks, the last one first. Returns nothing if the file needs read_mesh().
std::optional<Mesh> read_in_chunks(const std::filesystem::path& path, std::size_t chunk_bytes) {
  const auto chunks = open_mesh_chunks(path, {}, chunk_bytes);
  if (!chunks) return std::nullopt;
  const std::uint64_t count = chunks->count();
  std::vector<ChunkCounts> starts(count + 1);
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::optional<ChunkCounts> counts = chunks->counts(i);
    if (!counts) return std::nullopt;
    starts[i + 1] = {starts[i].vertices + counts->vertices,
                     starts[i].triangles + counts->triangles};
  }
  Mesh mesh;
  mesh.vertices.resize(starts[count].vertices);
  mesh.triangles.resize(starts[count].triangles);
  for (std::uint64_t i = count; i-- > 0;)
    chunks->read_vertices(
        i, std::span(mesh.vertices)
               .subspan(starts[i].vertices, starts[i + 1].vertices - starts[i].vertices));
  for (std::uint64_t i = count; i-- > 0;)
    chunks->read_triangles(
        i,
        {starts[i].vertices, mesh.vertices.size(),
         [&](std::uint32_t vertex) { return mesh.vertices.at(vertex); }},
        std::span(mesh.triangles)
            .subspan(starts[i].triangles, starts[i + 1].triangles - starts[i].triangles));
  return mesh;
}

class MeshChunksTest : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    write_text(folder_ / name, text);
    return folder_ / name;
  }

  TempDir folder_;
};

TEST_F(MeshChunksTest, AFileIsOpenedOnce) {
  // If it were opened again, another program could have emptied it since its size was checked.
  std::string stl(84 + 50, '\0');
  stl[80] = 1;
  for (const auto& path : {write("a.obj", random_obj(10, "\n")), write("a.stl", stl)}) {
    OpenCount count(path);
    EXPECT_NE(open_mesh_chunks(path, {}), nullptr);
    EXPECT_EQ(count.take(), 1) << path;
  }
}

TEST_F(MeshChunksTest, AnObjIsTheMeshOfReadMesh) {
  for (const char* line_end : {"\n", "\r\n", "\r"}) {
    const auto path = write("mesh.obj", random_obj(300, line_end));
    const Mesh whole = read_mesh(path);
    for (const std::size_t bytes : kChunkSizes) {
      const std::optional<Mesh> mesh = read_in_chunks(path, bytes);
      ASSERT_TRUE(mesh);
      EXPECT_EQ(mesh->vertices, whole.vertices) << bytes;
      EXPECT_EQ(mesh->triangles, whole.triangles) << bytes;
    }
  }
}

TEST_F(MeshChunksTest, ABinaryPlyOfTrianglesIsTheMeshOfReadMesh) {
  for (const bool big_endian : {false, true}) {
    const auto path = write("mesh.ply", random_ply(200, big_endian, 3));
    const Mesh whole = read_mesh(path);
    for (const std::size_t bytes : kChunkSizes) {
      const std::optional<Mesh> mesh = read_in_chunks(path, bytes);
      ASSERT_TRUE(mesh);
      EXPECT_EQ(mesh->vertices, whole.vertices) << bytes;
      EXPECT_EQ(mesh->triangles, whole.triangles) << bytes;
    }
  }
}

TEST_F(MeshChunksTest, ABinaryStlHasTheTrianglesOfReadMesh) {
  const auto path = write("mesh.stl", random_stl(200));
  const Mesh whole = read_mesh(path);
  for (const std::size_t bytes : kChunkSizes) {
    const std::optional<Mesh> mesh = read_in_chunks(path, bytes);
    ASSERT_TRUE(mesh);
    ASSERT_EQ(mesh->triangles.size(), whole.triangles.size());
    for (std::size_t t = 0; t < whole.triangles.size(); ++t)
      for (std::size_t corner = 0; corner < 3; ++corner)
        EXPECT_EQ(mesh->vertices[mesh->triangles[t][corner]],
                  whole.vertices[whole.triangles[t][corner]]);
    EXPECT_EQ(mesh->vertices.size() == whole.vertices.size(), bytes == kChunkBytes);
  }
  EXPECT_TRUE(open_mesh_chunks(path, {})->repeats_vertices());
}

TEST_F(MeshChunksTest, OtherFilesNeedReadMesh) {
  const auto needs_read_mesh = [&](const std::string& name, const std::string& text) {
    return !read_in_chunks(write(name, text), 64);
  };
  EXPECT_TRUE(needs_read_mesh("quads.ply", random_ply(20, false, 4)));
  EXPECT_TRUE(needs_read_mesh("ascii.ply",
                              "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                              "property float y\nproperty float z\nelement face 1\n"
                              "property list uchar int vertex_indices\nend_header\n"
                              "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
  EXPECT_TRUE(needs_read_mesh("mesh.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"));
  const std::string stl = random_stl(3);
  EXPECT_TRUE(needs_read_mesh("short.stl", stl.substr(0, stl.size() - 1)));
  EXPECT_TRUE(needs_read_mesh("empty.stl", ""));
}

TEST_F(MeshChunksTest, ErrorsAreThoseOfReadMesh) {
  std::string ply = random_ply(40, false, 3);
  std::string material = ply;
  ply[ply.size() - 4 - 5 - 1] = '\x7F';  // the last index of the last face
  material[material.size() - 4 - 1] = 2;
  const std::pair<const char*, std::string> files[] = {
      {"index.obj", random_obj(50, "\n") + "f 1 2 99999\n"},
      {"number.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 x 0\nf 1 2 3\n"},
      {"index.ply", ply},
      {"material.ply", material}};
  for (const auto& [name, text] : files) {
    const auto path = write(name, text);
    EXPECT_EQ(error_of([&] { read_in_chunks(path, 64); }), error_of([&] { read_mesh(path); }));
  }
}

TEST_F(MeshChunksTest, AnOriginIsSubtractedBeforeRounding) {
  const auto obj = write("mesh.obj", "v 1e6 0.1 0\nv 1000000.1 0 0\nv 1e6 0 1\nf 1 2 3\n");
  std::string bytes = random_ply(1, false, 3);
  const auto ply = write("mesh.ply", bytes), stl = write("mesh.stl", random_stl(1));
  for (const auto& path : {obj, ply, stl}) {
    std::vector<Vec3f> near(path == ply ? 5 : 3), far = near;
    const auto chunks = open_mesh_chunks(path, {});
    chunks->read_vertices(0, far);
    chunks->set_origin({1e6, 0, -1});
    chunks->read_vertices(0, near);
    for (std::size_t i = 0; i < near.size(); ++i) {
      if (path != obj) {
        EXPECT_EQ(near[i].x, static_cast<float>(double{far[i].x} - 1e6)) << path;
      }
      EXPECT_EQ(near[i].y, far[i].y);
      EXPECT_EQ(near[i].z, far[i].z + 1);
    }
    if (path == obj) {
      EXPECT_EQ(near[1].x, static_cast<float>(1000000.1 - 1e6));
    }
  }
}

TEST_F(MeshChunksTest, AnyPrefixIsSafe) {
  const std::pair<const char*, std::string> files[] = {{"mesh.obj", random_obj(6, "\n")},
                                                       {"mesh.ply", random_ply(6, true, 3)},
                                                       {"mesh.stl", random_stl(4)}};
  for (const auto& [name, text] : files)
    for (std::size_t size = 0; size <= text.size(); ++size) {
      const auto path = write(name, text.substr(0, size));
      try {
        const std::optional<Mesh> mesh = read_in_chunks(path, 32);
        if (!mesh) continue;
        for (const Triangle& triangle : mesh->triangles)
          for (const std::uint32_t index : triangle) EXPECT_LT(index, mesh->vertices.size());
      } catch (const Error& error) {
        EXPECT_EQ(error.file(), path.string());
      }
    }
}

}  // namespace
}  // namespace voxdag
