/// Tests that reading a large mesh into files keeps little of it resident.
#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>
#include <vector>

#include "support/peak_memory.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"

namespace voxdag {
namespace {

constexpr std::uint32_t kVertices = 1'000'000, kTriangles = 20'000'000;

/// Writes a binary PLY file of 272 MB.
void write_large_ply(const std::filesystem::path& path) {
  std::FILE* const file = std::fopen(path.c_str(), "wb");
  std::fprintf(file,
               "ply\nformat binary_little_endian 1.0\nelement vertex %u\nproperty float x\n"
               "property float y\nproperty float z\nelement face %u\n"
               "property list uchar uint vertex_indices\nend_header\n",
               kVertices, kTriangles);
  std::vector<Vec3f> vertices(kVertices);
  for (std::uint32_t i = 0; i < kVertices; ++i)
    vertices[i] = {static_cast<float>(i % 1000), static_cast<float>(i / 1000), 0};
  std::fwrite(vertices.data(), sizeof(Vec3f), kVertices, file);
  std::vector<char> rows(13 * std::size_t{1000});
  for (std::uint32_t first = 0; first < kTriangles; first += 1000) {
    for (std::uint32_t i = 0; i < 1000; ++i) {
      const std::uint32_t v = (first + i) / 20;
      const Triangle triangle{v, (v + 1) % kVertices, (v + 1000) % kVertices};
      rows[13 * i] = 3;
      std::memcpy(&rows[13 * i + 1], &triangle, sizeof triangle);
    }
    std::fwrite(rows.data(), 1, rows.size(), file);
  }
  std::fclose(file);
}

TEST(ResidentMemory, AMeshInFilesNeedsLittleOfIt) {
  const TempDir dir;
  write_large_ply(dir / "large.ply");
  MappedArrays arrays(dir.path());
  if (!reset_peak() || peak_bytes() == 0)
    GTEST_SKIP() << "the system does not measure the peak of resident memory";
  const std::uint64_t before = peak_bytes();
  const Mesh mesh = read_mesh(dir / "large.ply", {.arrays = &arrays});
  const std::uint64_t peak = peak_bytes() - before;
  std::printf("%.0f MB resident for a mesh of %.0f MB\n", static_cast<double>(peak) * 1e-6,
              static_cast<double>(arrays.bytes()) * 1e-6);
  EXPECT_EQ(mesh.triangles.size(), kTriangles);
  EXPECT_EQ(mesh.triangles.back()[0], kVertices - 1);
  EXPECT_LT(peak, arrays.bytes() / 2);
}

}  // namespace
}  // namespace voxdag
