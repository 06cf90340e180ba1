/// Parsing memory stays within 1.3 times the finished mesh. A program of its own: it counts every
/// allocation and looks at the resident set.
#include <gtest/gtest.h>
#include <malloc.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <new>

#include "support/temp_dir.hpp"
#include "voxdag/readers/read_mesh.hpp"

namespace {
std::atomic<std::size_t> live{0}, peak{0};

void* counted_allocate(std::size_t size) {
  void* p = std::malloc(size);
  if (p == nullptr) throw std::bad_alloc();
  const std::size_t now = live.fetch_add(malloc_usable_size(p)) + malloc_usable_size(p);
  std::size_t seen = peak.load();
  while (seen < now && !peak.compare_exchange_weak(seen, now)) {
  }
  return p;
}
}  // namespace

void* operator new(std::size_t size) { return counted_allocate(size); }
void operator delete(void* p) noexcept {
  live -= malloc_usable_size(p);
  std::free(p);
}
void operator delete(void* p, std::size_t) noexcept { operator delete(p); }

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
  /// Peak allocation while reading, over the bytes of the finished mesh.
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

}  // namespace
}  // namespace voxdag
