/// Tests that memory limits of builds are kept, or refused with a correct estimate. It is a
/// separate program, because it measures the process's resident memory.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <fstream>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "support/peak_memory.hpp"
#include "support/with_threads.hpp"
#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/dag/check_cover.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"

namespace voxdag {
namespace {

constexpr std::uint64_t kMebibyte = std::uint64_t{1} << 20;

/// Returns the resident bytes of this process.
std::uint64_t resident_bytes() {
  std::ifstream statm("/proc/self/statm");
  std::uint64_t total = 0, resident = 0;
  statm >> total >> resident;
  return resident * 4096;
}

/// Returns triangles much smaller than a voxel, all in a few voxels of a grid of the unit cube.
Mesh spot(std::size_t triangles) {
  std::mt19937 random(1);
  const auto coordinate = [&](double scale) {
    return static_cast<float>(scale * static_cast<double>(random() % 100000) / 100000);
  };
  Mesh mesh{{{0, 0, 0}, {1, 1, 1}, {0, 1, 0}}, {{0, 1, 2}}, {}, {}};
  for (std::size_t i = 0; i < triangles; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    const Vec3f at{0.5f + coordinate(0.001), 0.5f + coordinate(0.001), 0.5f + coordinate(0.001)};
    for (int corner = 0; corner < 3; ++corner)
      mesh.vertices.push_back(at + Vec3f{coordinate(2e-4), coordinate(2e-4), coordinate(2e-4)});
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

/// Returns bumpy spheres: a curved surface, whose DAG grows like the DAGs of real meshes.
Mesh bumpy_spheres(int side) {
  Mesh mesh;
  for (int sphere = 0; sphere < 8; ++sphere) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int v = 0; v <= side; ++v)
      for (int u = 0; u <= side; ++u) {
        const double a = 2 * M_PI * u / side, b = M_PI * v / side;
        const double r = 1 + 0.1 * std::sin(7 * a + sphere) * std::sin(5 * b);
        mesh.vertices.push_back(
            {static_cast<float>(3 * (sphere & 1) + r * std::cos(a) * std::sin(b)),
             static_cast<float>(3 * (sphere >> 1 & 1) + r * std::cos(b)),
             static_cast<float>(3 * (sphere >> 2) + r * std::sin(a) * std::sin(b))});
      }
    for (int v = 0; v < side; ++v)
      for (int u = 0; u < side; ++u) {
        const auto i = first + static_cast<std::uint32_t>(v * (side + 1) + u);
        const auto row = static_cast<std::uint32_t>(side + 1);
        mesh.triangles.push_back({i, i + 1, i + row});
        mesh.triangles.push_back({i + 1, i + row + 1, i + row});
      }
  }
  return mesh;
}

struct Case {
  const char* name;
  Mesh mesh;
  int levels;
  BuildMethod method;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const BuildMethod method :
       {BuildMethod::kHashConsed, BuildMethod::kSort, BuildMethod::kPaper}) {
    all.push_back({"spot", spot(200000), 10, method});
    all.push_back({"spheres", bumpy_spheres(60), 10, method});
    all.push_back({"spheres", bumpy_spheres(150), 11, method});
    all.push_back({"spheres at 64", bumpy_spheres(120), 6, method});
  }
  return all;
}

/// Returns the number between `words` and " MiB".
double mebibytes_behind(const std::string& text, const std::string& words) {
  const std::size_t at = text.find(words);
  return at == std::string::npos ? 0 : std::stod(text.substr(at + words.size()));
}

TEST(BuildMemory, ABudgetCountsWhatABuildTakes) {
  for (const Case& test : cases()) {
    MemoryBudget budget;
    const std::uint64_t before = resident_bytes();
    reset_peak();
    with_threads(
        2, [&] { build_svdag(test.mesh, fit_grid(test.mesh, test.levels), test.method, &budget); });
    const double taken = static_cast<double>(peak_bytes()) - static_cast<double>(before);
    EXPECT_LT(taken, 1.1 * static_cast<double>(budget.peak() + 6 * kMebibyte)) << test.name;
    EXPECT_EQ(budget.used(), 0u);
  }
}

TEST(BuildMemory, ALimitIsKeptOrRefusedWithATrueEstimate) {
  for (const Case& test : cases()) {
    const Grid grid = fit_grid(test.mesh, test.levels);
    MemoryBudget unlimited;
    const Svdag expected = build_svdag(test.mesh, grid, test.method, &unlimited).dag;
    const auto needed = static_cast<double>(unlimited.peak());
    // The largest case takes most of the time, so it tries one limit only.
    const std::vector<double> parts =
        test.levels == 11 ? std::vector{0.75} : std::vector{0.5, 0.75, 0.95, 1.1};
    for (const double part : parts) {
      MemoryBudget budget(static_cast<std::uint64_t>(needed * part));
      try {
        const Svdag dag = build_svdag(test.mesh, grid, test.method, &budget).dag;
        EXPECT_EQ(dag, expected) << test.name;
      } catch (const OverMemory& refusal) {
        EXPECT_LT(part, 1) << test.name << ": " << refusal.what();
        const double about = mebibytes_behind(refusal.what(), "needs about ");
        const double real = needed / static_cast<double>(kMebibyte);
        if (about == 0) {
          EXPECT_NE(std::string(refusal.what()).find("needs more than"), std::string::npos);
        } else {
          // Tables grow by doubling, so the memory of such small builds varies by a third from run
          // to run.
          EXPECT_LT(about, 2 * real + 2) << test.name << ": " << refusal.what();
          EXPECT_GT(about * 2 + 2, real) << test.name << ": " << refusal.what();
        }
      }
      EXPECT_LE(budget.peak(), budget.limit());
      EXPECT_EQ(budget.used(), 0u);
    }
  }
}

}  // namespace
}  // namespace voxdag
