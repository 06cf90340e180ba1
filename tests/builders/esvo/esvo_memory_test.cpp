#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "support/displaced_crate.hpp"
#include "support/grid_mesh.hpp"
#include "support/with_threads.hpp"
#include "voxdag/builders/esvo/build/build_esvo.hpp"
#include "voxdag/core/memory_budget.hpp"

namespace voxdag {
namespace {

/// Returns a bumpy sheet of 2 * n² triangles in a grid of 256³ voxels.
Mesh sheet(int n) {
  return test::grid_mesh(n, [=](int i, int j) {
    const float x = static_cast<float>(i) / static_cast<float>(n),
                y = static_cast<float>(j) / static_cast<float>(n);
    return Vec3f{250 * x, 250 * y, 120 + 80 * std::sin(9 * x) * std::cos(7 * y)};
  });
}

const Grid kMemoryGrid{8, {0, 0, 0}, 1.0, kSubvoxels};

/// Builds on four threads. Returns nothing if the memory is too small. Does not count the blocks.
std::optional<std::vector<std::uint64_t>> build_within(const Mesh& mesh, MemoryBudget* memory) {
  try {
    EsvoMemory sink;
    with_threads(4, [&] { build_esvo(mesh, kMemoryGrid, {}, nullptr, nullptr, sink, memory); });
    return sink.take();
  } catch (const OverMemory&) {
    return std::nullopt;
  }
}

TEST(EsvoMemoryLimit, AnyLimitIsKeptOrRefusedAndTheBytesAreTheSame) {
  const Mesh mesh = sheet(150);
  MemoryBudget unlimited;
  const auto expected = build_within(mesh, &unlimited);
  ASSERT_TRUE(expected);
  EXPECT_EQ(unlimited.used(), 0u);
  const std::uint64_t most = unlimited.peak();
  int built = 0, refused = 0;
  for (int percent = 5; percent <= 120; percent += 5) {
    MemoryBudget memory(most * static_cast<std::uint64_t>(percent) / 100);
    const auto esvo = build_within(mesh, &memory);
    EXPECT_EQ(memory.used(), 0u) << percent;
    EXPECT_LE(memory.peak(), memory.limit()) << percent;
    EXPECT_TRUE(!esvo || *esvo == *expected) << percent;
    (esvo ? built : refused) += 1;
  }
  // Fewer tasks at a time take less memory than all threads at once.
  EXPECT_GT(built, 5);
  EXPECT_GT(refused, 0);
}

TEST(EsvoMemoryLimit, TablesThatDoNotFitAreRefusedBeforeTheWork) {
  const Mesh mesh = sheet(100);
  MemoryBudget memory(500'000);
  EXPECT_FALSE(build_within(mesh, &memory));
  EXPECT_EQ(memory.peak(), 0u);
}

TEST(EsvoMemoryLimit, DisplacementAndTexturesAreCountedWhileTheyLive) {
  const Crate crate;
  MemoryBudget memory;
  {
    const SurfaceShading shading(crate.mesh, crate.appearance, nullptr, &memory);
    const DisplacedTriangles displaced(crate.mesh, crate.appearance,
                                       displace_all(crate.mesh, crate.appearance, stones(), 0.1),
                                       &memory);
    EXPECT_GT(memory.used(), crate.mesh.triangles.size() * sizeof(Box3d));
  }
  EXPECT_EQ(memory.used(), 0u);
}

}  // namespace
}  // namespace voxdag
