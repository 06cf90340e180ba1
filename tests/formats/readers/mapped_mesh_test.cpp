/// Tests that meshes whose arrays are in files equal meshes in memory, and need little memory.

#include <functional>

#include "formats/readers/mesh_text.hpp"
#include "support/error_of.hpp"
#include "support/file_size_limit.hpp"
#include "support/grid_mesh.hpp"
#include "support/temp_dir.hpp"
#include "support/with_threads.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/mesh/mesh_memory.hpp"

namespace voxdag {
namespace {

/// Returns a wavy sheet: 3 MiB in memory. Its coordinates are short decimal numbers.
Mesh sheet() {
  return test::grid_mesh(300, [](int i, int j) {
    return Vec3f{static_cast<float>(i), static_cast<float>(j), static_cast<float>(i * j % 7) / 4};
  });
}

/// The corners of a face that is not convex, so that readers replace its fan.
constexpr std::uint32_t kDart[4] = {0, 601, 2, 302};

void append_point(std::string& text, Vec3f p) {
  for (int axis = 0; axis < 3; ++axis) text.append(" ").append(std::to_string(p[axis]));
}

std::string obj_bytes(const Mesh& mesh) {
  std::string text = "usemtl a\n";
  for (const Vec3f p : mesh.vertices) {
    text += "v";
    append_point(text, p);
    text += "\n";
  }
  const auto face = [&](std::span<const std::uint32_t> corners) {
    text += "f";
    for (const std::uint32_t i : corners) text.append(" ").append(std::to_string(i + 1));
    text += "\n";
  };
  face(kDart);
  text += "usemtl b\n";
  for (const Triangle& triangle : mesh.triangles) face(triangle);
  return text;
}

std::string ply_bytes(const Mesh& mesh, bool is_ascii) {
  std::string bytes = "ply\nformat ";
  bytes += is_ascii ? "ascii" : "binary_little_endian";
  bytes += " 1.0\nelement vertex " + std::to_string(mesh.vertices.size());
  bytes += "\nproperty float x\nproperty float y\nproperty float z\nelement face ";
  bytes += std::to_string(mesh.triangles.size() + 1);
  bytes += "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3f p : mesh.vertices)
    if (is_ascii) {
      append_point(bytes, p);
      bytes += "\n";
    } else {
      append(bytes, p);
    }
  const auto face = [&](std::span<const std::uint32_t> corners) {
    if (is_ascii)
      bytes += std::to_string(corners.size());
    else
      bytes += static_cast<char>(corners.size());
    for (const std::uint32_t i : corners)
      if (is_ascii)
        bytes.append(" ").append(std::to_string(i));
      else
        append(bytes, i);
    if (is_ascii) bytes += "\n";
  };
  face(kDart);
  for (const Triangle& triangle : mesh.triangles) face(triangle);
  return bytes;
}

std::string stl_bytes(const Mesh& mesh, bool is_ascii) {
  std::string bytes = "solid sheet\n";
  if (!is_ascii) {
    bytes.assign(80, ' ');
    append(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  }
  for (const Triangle& triangle : mesh.triangles) {
    bytes += is_ascii ? "facet normal 0 0 1\nouter loop\n" : std::string(12, '\0');
    for (const std::uint32_t i : triangle)
      if (is_ascii) {
        bytes += "vertex";
        append_point(bytes, mesh.vertices[i]);
        bytes += "\n";
      } else {
        append(bytes, mesh.vertices[i]);
      }
    bytes += is_ascii ? "endloop\nendfacet\n" : std::string(2, '\0');
  }
  return is_ascii ? bytes + "endsolid sheet\n" : bytes;
}

std::string off_bytes(const Mesh& mesh) {
  std::string text = "OFF\n" + std::to_string(mesh.vertices.size()) + " " +
                     std::to_string(mesh.triangles.size() + 1) + " 0\n";
  for (const Vec3f p : mesh.vertices) {
    append_point(text, p);
    text += "\n";
  }
  const auto face = [&](std::span<const std::uint32_t> corners) {
    text += std::to_string(corners.size());
    for (const std::uint32_t i : corners) text.append(" ").append(std::to_string(i));
    text += "\n";
  };
  face(kDart);
  for (const Triangle& triangle : mesh.triangles) face(triangle);
  return text;
}

std::string glb_bytes(const Mesh& mesh) {
  const std::size_t position_bytes = mesh.vertices.size() * sizeof(Vec3f);
  const std::size_t index_bytes = mesh.triangles.size() * sizeof(Triangle);
  const std::string positions = std::to_string(position_bytes);
  std::string json =
      R"({"asset":{"version":"2.0"},"materials":[{"name":"a"}],"meshes":[{"primitives":[{)"
      R"("attributes":{"POSITION":0},"indices":1,"material":0}]}],"accessors":[{"bufferView":0,)"
      R"("componentType":5126,"type":"VEC3","count":)" +
      std::to_string(mesh.vertices.size()) +
      R"(},{"bufferView":1,"componentType":5125,"type":"SCALAR","count":)" +
      std::to_string(3 * mesh.triangles.size()) + R"(}],"bufferViews":[{"buffer":0,"byteLength":)" +
      positions + R"(},{"buffer":0,"byteOffset":)" + positions + R"(,"byteLength":)" +
      std::to_string(index_bytes) + R"(}],"buffers":[{"byteLength":)" +
      std::to_string(position_bytes + index_bytes) + "}]}";
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string bytes = "glTF";
  const auto number = [&](std::size_t value) { append(bytes, static_cast<std::uint32_t>(value)); };
  number(2);
  number(12 + 8 + json.size() + 8 + position_bytes + index_bytes);
  number(json.size());
  bytes += "JSON" + json;
  number(position_bytes + index_bytes);
  bytes += std::string("BIN\0", 4);
  for (const Vec3f p : mesh.vertices) append(bytes, p);
  for (const Triangle& triangle : mesh.triangles) append(bytes, triangle);
  return bytes;
}

/// The formats, each with a file of the sheet and a damaged file.
class MappedMesh : public testing::TestWithParam<const char*> {
 protected:
  /// Returns the bytes of a file in the format.
  static std::string bytes() {
    const std::string format = GetParam();
    const Mesh mesh = sheet();
    if (format == "obj") return obj_bytes(mesh);
    if (format == "off") return off_bytes(mesh);
    if (format == "glb") return glb_bytes(mesh);
    const bool is_ascii = format.starts_with("ascii");
    return format.ends_with("ply") ? ply_bytes(mesh, is_ascii) : stl_bytes(mesh, is_ascii);
  }
  /// Returns the bytes with a fault at their end.
  static std::string damaged_bytes() {
    const std::string format = GetParam();
    std::string damaged = bytes();
    if (format == "binary_stl")  // No vertex is finite.
      damaged.replace(84, damaged.size() - 84, damaged.size() - 84, '\xFF');
    else if (format == "glb" || format == "binary_ply")
      damaged.replace(damaged.size() - 6, 6, 6, '\xFF');
    else if (format == "ascii_stl")
      damaged += "facet\n";
    else
      damaged.replace(damaged.size() - 1, 1, "99999999\n");
    return damaged;
  }
  std::filesystem::path write(const std::string& text) {
    const std::string format = GetParam();
    std::filesystem::path file = files_ / ("mesh." + format.substr(format.size() - 3));
    write_text(file, text);
    return file;
  }

  TempDir files_, folder_;
  MappedArrays arrays_{folder_.path()};
};

TEST_P(MappedMesh, EqualsTheMeshInMemory) {
  const auto file = write(bytes());
  const Mesh expected = read_mesh(file);
  {
    const Mesh mesh = read_mesh(file, {.arrays = &arrays_});
    EXPECT_TRUE(mesh == expected);
    EXPECT_EQ(mesh.vertices.get_allocator().store(), &arrays_);
    EXPECT_EQ(mesh.triangles.get_allocator().store(), &arrays_);
    EXPECT_EQ(mesh.triangle_materials.get_allocator().store(), &arrays_);
    EXPECT_EQ(folder_.count(), 0);
  }
  const MeshWithAppearance whole = read_mesh_with_appearance(file, {.arrays = &arrays_});
  EXPECT_TRUE(whole.mesh == expected);
}

TEST_P(MappedMesh, IsReadWithinABudgetThatIsTooSmallForTheMeshInMemory) {
  const auto file = write(bytes());
  const std::uint64_t limit = std::uint64_t{2} << 20;
  with_threads(2, [&] {  // Each thread needs scratch memory.
    MemoryBudget budget(limit), too_small(limit);
    EXPECT_THROW(read_mesh(file, {.work = &too_small}), OverMemory);
    const Mesh mesh = read_mesh(file, {.work = &budget, .arrays = &arrays_});
    EXPECT_GT(arrays_.bytes(), limit);
    EXPECT_EQ(budget.used(), memory_bytes(mesh));
    EXPECT_LT(budget.used(), 1000u);
  });
}

TEST_P(MappedMesh, AFaultInTheFileIsReportedAndLeavesNoFiles) {
  const auto file = write(damaged_bytes());
  const std::string message = error_of([&] { read_mesh(file); });
  EXPECT_TRUE(message.starts_with(file.string())) << message;
  EXPECT_EQ(error_of([&] { read_mesh(file, {.arrays = &arrays_}); }), message);
  EXPECT_EQ(arrays_.bytes(), 0u);
  EXPECT_EQ(folder_.count(), 0);
}

TEST_P(MappedMesh, AFullDiskIsAnErrorThatNamesTheFolder) {
  const auto file = write(bytes());
  const FileSizeLimit limit(1 << 18);
  const std::string message = error_of([&] { read_mesh(file, {.arrays = &arrays_}); });
  EXPECT_TRUE(message.starts_with(folder_.path().string() + ": cannot make a file")) << message;
  EXPECT_EQ(arrays_.bytes(), 0u);
}

INSTANTIATE_TEST_SUITE_P(Formats, MappedMesh,
                         testing::Values("obj", "ascii_ply", "binary_ply", "ascii_stl",
                                         "binary_stl", "off", "glb"),
                         [](const auto& test) { return std::string(test.param); });

}  // namespace
}  // namespace voxdag
