/// Tests that the memory of readers stays within 1.3 times the finished mesh, and within a budget.
/// It is a separate program, because it replaces operator new to count all allocations.
#include <gtest/gtest.h>
#include <malloc.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <new>
#include <optional>

#include "support/temp_dir.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/mesh/mesh_memory.hpp"

namespace {
std::atomic<std::size_t> live{0}, peak{0};

void* counted_allocate(std::size_t size, std::size_t alignment = alignof(std::max_align_t)) {
  void* p = std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (p == nullptr) throw std::bad_alloc();
  const std::size_t now = live.fetch_add(malloc_usable_size(p)) + malloc_usable_size(p);
  std::size_t seen = peak.load();
  while (seen < now && !peak.compare_exchange_weak(seen, now)) {
  }
  return p;
}
}  // namespace

void* operator new(std::size_t size) { return counted_allocate(size); }
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted_allocate(size, std::max(static_cast<std::size_t>(alignment), sizeof(void*)));
}
void operator delete(void* p) noexcept {
  live -= malloc_usable_size(p);
  std::free(p);
}
void operator delete(void* p, std::size_t) noexcept { operator delete(p); }
void operator delete(void* p, std::align_val_t) noexcept { operator delete(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { operator delete(p); }

namespace voxdag {
namespace {

constexpr int kSide = 700;  ///< Vertices along each side of the test's grid.

double height(int x, int y) { return std::sin(x * 0.1) * std::cos(y * 0.07); }

/// Calls body(a, b, c) for the triangles of a grid.
template <class Body>
void for_each_triangle(const Body& body) {
  for (int y = 0; y + 1 < kSide; ++y)
    for (int x = 0; x + 1 < kSide; ++x) {
      const int i = y * kSide + x;
      body(i, i + 1, i + kSide);
      body(i + 1, i + kSide + 1, i + kSide);
    }
}

class MeshMemory : public testing::Test {
 protected:
  /// Returns the peak allocation during a read, divided by the bytes of the finished mesh.
  double ratio(const char* name, std::size_t triangles = std::size_t{2} * (kSide - 1) * (kSide - 1),
               std::size_t vertices = std::size_t{kSide} * kSide) {
    const auto path = directory_.path() / name;
    const std::size_t before = live;
    peak = before;
    const Mesh mesh = read_mesh(path);
    EXPECT_EQ(mesh.triangles.size(), triangles);
    EXPECT_EQ(mesh.vertices.size(), vertices);
    const std::size_t bytes =
        12 * mesh.vertices.size() + 12 * mesh.triangles.size() + 4 * mesh.triangle_materials.size();
    std::printf("%s: %.3f\n", name,
                static_cast<double>(peak - before) / static_cast<double>(bytes));
    return static_cast<double>(peak - before) / static_cast<double>(bytes);
  }
  std::FILE* open(const char* name) { return std::fopen((directory_.path() / name).c_str(), "wb"); }
  TempDir directory_;
};

TEST_F(MeshMemory, ObjStaysWithinItsBound) {
  std::FILE* file = open("grid.obj");
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) std::fprintf(file, "v %d %d %.9g\n", x, y, height(x, y));
  for_each_triangle(
      [&](int a, int b, int c) { std::fprintf(file, "f %d %d %d\n", a + 1, b + 1, c + 1); });
  std::fclose(file);
  EXPECT_LT(ratio("grid.obj"), 1.3);
}

TEST_F(MeshMemory, PlyStaysWithinItsBound) {
  for (const bool is_ascii : {true, false}) {
    std::FILE* file = open("grid.ply");
    std::fprintf(file,
                 "ply\nformat %s 1.0\nelement vertex %d\nproperty float x\nproperty float y\n"
                 "property float z\nelement face %d\nproperty list uchar int vertex_indices\n"
                 "end_header\n",
                 is_ascii ? "ascii" : "binary_little_endian", kSide * kSide,
                 2 * (kSide - 1) * (kSide - 1));
    for (int y = 0; y < kSide; ++y)
      for (int x = 0; x < kSide; ++x) {
        const float p[3] = {static_cast<float>(x), static_cast<float>(y),
                            static_cast<float>(height(x, y))};
        if (is_ascii)
          std::fprintf(file, "%.9g %.9g %.9g\n", static_cast<double>(p[0]),
                       static_cast<double>(p[1]), static_cast<double>(p[2]));
        else
          std::fwrite(p, 1, 12, file);
      }
    for_each_triangle([&](int a, int b, int c) {
      const int corners[3] = {a, b, c};
      if (is_ascii) {
        std::fprintf(file, "3 %d %d %d\n", a, b, c);
      } else {
        std::fputc(3, file);
        std::fwrite(corners, 1, 12, file);
      }
    });
    std::fclose(file);
    EXPECT_LT(ratio("grid.ply"), 1.3);
  }
}

TEST_F(MeshMemory, StlStaysWithinItsBound) {
  for (const bool is_ascii : {true, false}) {
    std::FILE* file = open("grid.stl");
    const std::uint32_t count = 2 * (kSide - 1) * (kSide - 1);
    if (is_ascii) {
      std::fputs("solid grid\n", file);
    } else {
      std::fwrite(std::string(80, ' ').data(), 1, 80, file);
      std::fwrite(&count, 1, 4, file);
    }
    for_each_triangle([&](int a, int b, int c) {
      if (is_ascii) std::fputs("facet normal 0 0 1\nouter loop\n", file);
      const std::string zeros(12, '\0');
      if (!is_ascii) std::fwrite(zeros.data(), 1, 12, file);
      for (const int i : {a, b, c}) {
        const float p[3] = {static_cast<float>(i % kSide), static_cast<float>(i / kSide),
                            static_cast<float>(height(i % kSide, i / kSide))};
        if (is_ascii)
          std::fprintf(file, "vertex %.9g %.9g %.9g\n", static_cast<double>(p[0]),
                       static_cast<double>(p[1]), static_cast<double>(p[2]));
        else
          std::fwrite(p, 1, 12, file);
      }
      if (is_ascii) std::fputs("endloop\nendfacet\n", file);
      if (!is_ascii) std::fwrite(zeros.data(), 1, 2, file);
    });
    if (is_ascii) std::fputs("endsolid grid\n", file);
    std::fclose(file);
    EXPECT_LT(ratio("grid.stl"), 1.3);
  }
}

TEST_F(MeshMemory, StlWithoutSharedCornersStaysWithinItsBound) {
  constexpr std::uint32_t kFacets = 600'000;
  std::FILE* file = open("soup.stl");
  std::fwrite(std::string(80, ' ').data(), 1, 80, file);
  std::fwrite(&kFacets, 1, 4, file);
  std::array<float, 12> facet{};
  for (std::uint32_t i = 0; i < kFacets; ++i) {
    for (std::size_t k = 3; k < 12; ++k) facet[k] = static_cast<float>(12 * i + k);
    std::fwrite(facet.data(), 4, 12, file);
    std::fwrite(facet.data(), 1, 2, file);
  }
  std::fclose(file);
  EXPECT_LT(ratio("soup.stl", kFacets, 3 * kFacets), 1.3);
}

constexpr std::uint64_t kMiB = std::uint64_t{1} << 20;

/// Files that need more memory than their size suggests, each of a few MiB.
class ReaderBudget : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& bytes) {
    std::ofstream(directory_.path() / name, std::ios::binary) << bytes;
    return directory_.path() / name;
  }

  /// Reads a file within `limit` bytes (0: counts only). Checks that allocations stay within the
  /// count, and the count within the limit. Returns the peak of the count, or nothing if the limit
  /// was too small.
  std::optional<std::uint64_t> read(const std::filesystem::path& file, std::uint64_t limit,
                                    bool with_appearance) {
    MemoryBudget budget(limit);
    const ReadOptions options{.work = &budget};
    const std::size_t before = live;
    peak = before;
    const auto check = [&](std::uint64_t counted) {
      EXPECT_LE(peak - before, counted + counted / 10 + 2 * kMiB) << file;
    };
    try {
      MeshWithAppearance result;
      if (with_appearance)
        result = read_mesh_with_appearance(file, options);
      else
        result.mesh = read_mesh(file, options);
      check(budget.peak());
      EXPECT_EQ(budget.used(), memory_bytes(result.mesh) + memory_bytes(result.appearance));
      EXPECT_TRUE(limit == 0 || budget.peak() <= limit);
      return budget.peak();
    } catch (const OverMemory& error) {
      check(limit);
      EXPECT_EQ(error.file(), file.string());
      EXPECT_EQ(budget.used(), 0u) << file;
      return std::nullopt;
    }
  }

  /// Expects that a file is read with the memory that it needs, and refused with less.
  void expect_bounded(const std::filesystem::path& file) {
    for (const bool with_appearance : {false, true}) {
      const auto needed = read(file, 0, with_appearance);
      ASSERT_TRUE(needed);
      EXPECT_GT(*needed, kMiB);
      for (const int percent : {5, 30, 60, 90})
        EXPECT_FALSE(
            read(file, *needed * static_cast<std::uint64_t>(percent) / 100, with_appearance))
            << file << " at " << percent << "%";
      EXPECT_TRUE(read(file, *needed + *needed / 4 + 4 * kMiB, with_appearance)) << file;
    }
  }

  TempDir directory_;
};

std::string numbers(int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += std::to_string(i * 37 % 1000) + " ";
  return text;
}

TEST_F(ReaderBudget, ObjArraysAttributesAndNamesCount) {
  std::string grid, names, colors;
  for (int i = 0; i < 60'000; ++i) {
    const std::string n = std::to_string(i % 977), number = std::to_string(i);
    grid.append("v ").append(n).append(" ").append(number).append(" 0\nvt 0.").append(n);
    grid += " 0\nvn 0 0 1\n";
    if (i > 4) grid += "f -1/-1/-1 -2/-2/-2 -3/-3/-3 -4/-4/-4\n";
    names.append("usemtl material_of_some_length_").append(number).append("\n");
    colors.append("v ").append(n).append(" ").append(number).append(" 0 0.5 0.5 0.5\nf 1 2 -1\n");
  }
  expect_bounded(write("grid.obj", grid));
  expect_bounded(write("names.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n" + names + "f 1 2 3\n"));
  expect_bounded(write("colors.obj", colors));
}

TEST_F(ReaderBudget, PlyArraysAndAttributesCount) {
  for (const bool has_attributes : {false, true}) {
    std::string rows, faces;
    for (int i = 0; i < 60'000; ++i) {
      rows += numbers(has_attributes ? 11 : 3) + "\n";
      faces.append("3 ").append(std::to_string(i)).append(" 1 2\n");
    }
    std::string header = "ply\nformat ascii 1.0\nelement vertex 60000\n";
    for (const char* name : {"x", "y", "z", "nx", "ny", "nz", "s", "t", "red", "green", "blue"})
      if (has_attributes || name[1] == '\0')
        if (has_attributes || (name[0] != 's' && name[0] != 't'))
          header.append("property float ").append(name).append("\n");
    expect_bounded(write("a.ply", header + "element face 60000\nproperty list uchar int " +
                                      "vertex_index\nend_header\n" + rows + faces));
  }
}

TEST_F(ReaderBudget, StlAndOffArraysCount) {
  std::string stl(80, ' '), off = "OFF\n120000 40000 0\n";
  const std::uint32_t facets = 40'000;
  stl.append(reinterpret_cast<const char*>(&facets), 4);
  for (std::uint32_t i = 0; i < facets; ++i) {
    std::array<float, 13> facet{};
    for (std::size_t k = 3; k < 12; ++k) facet[k] = static_cast<float>(12 * i + k);
    stl.append(reinterpret_cast<const char*>(facet.data()), 50);
    off.append("1 2 3\n4 5 ").append(std::to_string(i)).append("\n7 8 9\n");
  }
  for (std::uint32_t i = 0; i < facets; ++i)
    off.append("3 0 1 ").append(std::to_string(i)).append("\n");
  expect_bounded(write("a.stl", stl));
  expect_bounded(write("a.off", off));
}

const std::string kGltfStart = R"({"asset":{"version":"2.0"},)";

TEST_F(ReaderBudget, GltfInstancesJsonAndDataUrisCount) {
  // Positions without a buffer, shown 20 times: 784 bytes that stand for 4 GB.
  std::string nodes = "{\"mesh\":0}", roots = "0";
  for (int i = 1; i < 20; ++i) {
    nodes += ",{\"mesh\":0}";
    roots.append(",").append(std::to_string(i));
  }
  const auto bomb = [&](const std::string& count) {
    return kGltfStart + R"("scenes":[{"nodes":[)" + roots + R"(]}],"nodes":[)" + nodes +
           R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{)" +
           R"("componentType":5126,"count":)" + count +
           R"(,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":0,"componentType":5121},)" +
           R"("values":{"bufferView":1}}}],"bufferViews":[{"buffer":0,"byteLength":1},)" +
           R"({"buffer":0,"byteOffset":4,"byteLength":12}],"buffers":[{"byteLength":16,"uri":)" +
           R"("data:;base64,AAAAAAAAAAAAAAAAAAAAAA=="}]})";
  };
  EXPECT_FALSE(read(write("bomb.gltf", bomb("16777216")), 100 * kMiB, false));
  expect_bounded(write("small.gltf", bomb("9999")));
  // A triangle and values that nothing uses.
  const std::string triangle =
      R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,)"
      R"("componentType":5126,"count":3,"type":"VEC3"}],"bufferViews":[{"buffer":0,"byteLength":36}],)";
  const std::string buffer = R"("buffers":[{"byteLength":36,"uri":"data:;base64,)";
  std::string ones = "1";
  for (int i = 0; i < 300'000; ++i) ones += ",1";
  expect_bounded(write("json.gltf", kGltfStart + triangle + "\"extras\":[" + ones + "]," + buffer +
                                        std::string(48, 'A') + "\"}]}"));
  expect_bounded(write("data.gltf", kGltfStart + triangle + buffer +
                                        std::string(std::size_t{4} << 20, 'A') + "\"}]}"));
  expect_bounded(write(
      "deep.gltf", kGltfStart + triangle + "\"extras\":" + std::string(200'000, '[') +
                       std::string(200'000, ']') + "," + buffer + std::string(48, 'A') + "\"}]}"));
}

TEST_F(ReaderBudget, GltfImagesThatShareABufferViewAreNotCopiedWithoutEnd) {
  std::string images = "{\"bufferView\":0}";
  for (int i = 0; i < 2000; ++i) images += ",{\"bufferView\":0}";
  const auto file = write(
      "a.gltf",
      kGltfStart +
          R"("meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{"bufferView":0,)"
          R"("componentType":5126,"count":3,"type":"VEC3"}],"bufferViews":[{"buffer":0,)"
          R"("byteLength":3000000}],"images":[)" +
          images + R"(],"buffers":[{"byteLength":3000000,"uri":"data:;base64,)" +
          std::string(4'000'000, 'A') + "\"}]}");
  const MeshWithAppearance result = read_mesh_with_appearance(file);
  EXPECT_LT(memory_bytes(result.appearance), 16 * kMiB);
  EXPECT_EQ(result.warnings.size(), 201u);  // The last one counts the others.
}

}  // namespace
}  // namespace voxdag
