// The bodies of real scans against the integrals of their meshes. The folder that VOXDAG_SCENES
// names has them.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <random>

#include "bodies.hpp"
#include "voxdag/algebra/combine.hpp"
#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/solid/fill_solid.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"
#include "voxdag/stored/svdag/svdag_lookup.hpp"

namespace voxdag {
namespace {

/// Returns the path of a scan; an empty one if there is none.
std::filesystem::path scan_path(const std::string& name) {
  const char* const folder = std::getenv("VOXDAG_SCENES");
  if (folder == nullptr) return {};
  const std::filesystem::path path = std::filesystem::path(folder) / "scans" / name;
  return std::filesystem::exists(path) ? path : std::filesystem::path();
}

std::uint64_t voxels_of(const Svdag& dag) { return count_svdag(dag.view()).voxels; }

TEST(Scans, TheVolumeOfArmadilloIsItsIntegralWithinTheSurface) {
  const std::filesystem::path path = scan_path("armadillo.obj");
  if (path.empty()) GTEST_SKIP() << "VOXDAG_SCENES names no folder with scans/armadillo.obj";
  const Mesh mesh = read_mesh(path);
  double integral = 0;
  for (const Triangle& t : mesh.triangles)
    integral += dot(static_cast<Vec3d>(mesh.vertices[t[0]]),
                    cross(static_cast<Vec3d>(mesh.vertices[t[1]]),
                          static_cast<Vec3d>(mesh.vertices[t[2]]))) /
                6;
  for (const int levels : {6, 8, 10}) {
    const Grid grid = fit_grid(mesh, levels);
    const Svdag cover = build_svdag(mesh, grid).dag;
    const Svdag solid = fill_solid(cover.view(), mesh, grid, {SolidRule::kParity});
    const double voxel = std::pow(grid.voxel_size, 3);
    const double all = voxel * static_cast<double>(voxels_of(solid)),
                 surface = voxel * static_cast<double>(voxels_of(cover));
    EXPECT_GE(all, std::abs(integral));
    EXPECT_LE(all - surface, std::abs(integral));
    EXPECT_EQ(fill_solid(cover.view(), mesh, grid, {SolidRule::kWinding}), solid);
  }
}

/// The scan of the bunny has holes in its base.
TEST(Scans, TheBunnyIsThatOfItsWindingNumbers) {
  const std::filesystem::path path = scan_path("stanford-bunny.obj");
  if (path.empty()) GTEST_SKIP() << "VOXDAG_SCENES names no folder with scans/stanford-bunny.obj";
  const Mesh mesh = read_mesh(path);
  const Grid grid = fit_grid(mesh, 7);
  const Svdag cover = build_svdag(mesh, grid).dag;
  const Svdag solid = fill_solid(cover.view(), mesh, grid, {SolidRule::kWinding});
  std::mt19937 rng(1);
  const auto any = [&] { return static_cast<std::int32_t>(rng() % 128); };
  int inside = 0;
  for (int i = 0; i < 300; ++i) {
    // Half of them near the base.
    const Vec3i voxel{any(), i % 2 == 0 ? any() : any() % 12, any()};
    if (svdag_contains(cover.view(), voxel, 7)) continue;
    const double winding =
        winding_number(mesh, grid.to_world(static_cast<Vec3d>(voxel) + Vec3d{0.5, 0.5, 0.5}));
    // The builder's vertices are rounded to 1/256 voxel.
    if (std::abs(std::abs(winding) - 0.5) < 1e-2) continue;
    EXPECT_EQ(svdag_contains(solid.view(), voxel, 7), std::abs(winding) >= 0.5);
    inside += std::abs(winding) >= 0.5 ? 1 : 0;
  }
  EXPECT_GT(inside, 20);
}

}  // namespace
}  // namespace voxdag
