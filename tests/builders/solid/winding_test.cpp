// Generalised winding numbers, and the bodies of meshes that are not closed, against sums of all
// solid angles.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "bodies.hpp"
#include "support/brute_svdag.hpp"
#include "support/error_of.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/solid/fill_solid.hpp"
#include "voxdag/builders/solid/winding/boundary_caps.hpp"
#include "voxdag/builders/solid/winding/edge_tree.hpp"
#include "voxdag/builders/solid/winding/winding_tree.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"
#include "voxdag/stored/svdag/svdag_lookup.hpp"

namespace voxdag {
namespace {

/// Returns a mesh as the builder sees it, with vertices in units of 1/256 voxel.
Mesh quantized_mesh(const Mesh& mesh, const Grid& grid) {
  const QuantizedMesh quantized(mesh, grid);
  Mesh result;
  for (std::size_t i = 0; i < quantized.triangle_count(); ++i) {
    const auto first = static_cast<std::uint32_t>(result.vertices.size());
    for (int corner = 0; corner < 3; ++corner)
      result.vertices.push_back(static_cast<Vec3f>(quantized.triangle(i)[corner]));
    result.triangles.push_back({first, first + 1, first + 2});
  }
  return result;
}

PageVector<QuantizedTriangle> triangles_of(const Mesh& mesh, const Grid& grid) {
  const QuantizedMesh quantized(mesh, grid);
  PageVector<QuantizedTriangle> triangles;
  for (std::size_t i = 0; i < quantized.triangle_count(); ++i)
    triangles.push_back(quantized.triangle(i));
  return triangles;
}

struct Filled {
  int inside = 0, in_holes = 0, undecided = 0;
};

/// Expects that fill_solid() adds the voxels whose winding number reaches the threshold, leaves out
/// those that the body only touches, and changes no others. Counts those inside, and those whose
/// winding number is not near a whole number.
Filled expect_winding(const Mesh& mesh, const Grid& grid, double threshold = 0.5) {
  const Svdag cover = build_svdag(mesh, grid).dag;
  const Svdag solid = fill_solid(cover.view(), mesh, grid, {SolidRule::kWinding, threshold});
  const Mesh units = quantized_mesh(mesh, grid);
  Filled filled;
  const auto winding_of = [&](Vec3i v) {
    return std::abs(winding_number(units, (static_cast<Vec3d>(v) + Vec3d{0.5, 0.5, 0.5}) * 256.0));
  };
  const TouchedVoxels touched(mesh, grid, [&](Vec3i v) { return winding_of(v) >= threshold; });
  const std::vector<Vec3i> expected = voxels_where(grid.levels, [&](Vec3i v) {
    if (svdag_contains(cover.view(), v, grid.levels)) return !touched.contains(v);
    const double winding = winding_of(v);
    // The voxel's point is up to half a unit beside its centre.
    if (std::abs(winding - threshold) < 1e-3) {
      ++filled.undecided;
      return svdag_contains(solid.view(), v, grid.levels);
    }
    filled.inside += winding >= threshold ? 1 : 0;
    filled.in_holes += std::abs(winding - std::round(winding)) > 0.1 ? 1 : 0;
    return winding >= threshold;
  });
  EXPECT_EQ(solid, brute_svdag(grid.levels, expected));
  return filled;
}

void remove_triangles(Mesh& mesh, double part, std::mt19937& rng) {
  std::erase_if(mesh.triangles,
                [&](const Triangle&) { return std::uniform_real_distribution<>()(rng) < part; });
}

void flip_triangles(Mesh& mesh, double part, std::mt19937& rng) {
  for (Triangle& t : mesh.triangles)
    if (std::uniform_real_distribution<>()(rng) < part) std::swap(t[0], t[1]);
}

TEST(WindingTree, ErrorsAreWithinTheirBounds) {
  std::mt19937 rng(2);
  Mesh mesh;
  add_rough_ball(mesh, {0, 0, 0}, 5, 0.3, 30, rng);
  remove_triangles(mesh, 0.2, rng);
  flip_triangles(mesh, 0.1, rng);
  const Grid grid = fit_grid(mesh, 6);
  const Mesh units = quantized_mesh(mesh, grid);
  const WindingTree tree(triangles_of(mesh, grid), {});
  std::uniform_real_distribution<double> place(-64 * 256, 128 * 256);
  double largest = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec3d point{place(rng), place(rng), place(rng)};
    const double exact = winding_number(units, point);
    for (const double tolerance : {0.25, 0.01, 1e-4, 0.0}) {
      const WindingValue value = tree.around(point, tolerance);
      EXPECT_LE(value.error, 5 * tolerance);
      EXPECT_LE(std::abs(value.value - exact), value.error + 1e-9);
      largest = std::max(largest, std::abs(value.value - exact));
    }
  }
  EXPECT_GT(largest, 1e-4);  // it does approximate
}

TEST(WindingTree, HasNoTrianglesToBeginWith) {
  const WindingTree tree(PageVector<QuantizedTriangle>(), {});
  EXPECT_EQ(tree.around({1, 2, 3}, 0).value, 0);
}

TEST(BoundaryCaps, CloseTheMesh) {
  std::mt19937 rng(3);
  for (int round = 0; round < 20; ++round) {
    Mesh mesh;
    add_rough_ball(mesh, {0, 0, 0}, 5, 0.3, 8, rng);
    add_box(mesh, {-3, -4, -5}, {9, 6, 7});
    // Some triangles twice.
    for (std::size_t i = 0; i < 5; ++i) mesh.triangles.push_back(mesh.triangles[rng() % 100]);
    remove_triangles(mesh, 0.05 * round, rng);
    flip_triangles(mesh, 0.02 * round, rng);
    const Grid grid = fit_grid(mesh, 5);
    const QuantizedMesh quantized(mesh, grid);
    const Mesh units = quantized_mesh(mesh, grid);
    const WindingTree caps(cap_boundary(find_boundary_edges(quantized, {}), {}), {});
    std::uniform_real_distribution<double> place(0, 32 * 256);
    for (int i = 0; i < 50; ++i) {
      const Vec3d point{place(rng), place(rng), place(rng)};
      const double both = winding_number(units, point) - caps.around(point, 0).value;
      EXPECT_NEAR(both, std::round(both), 1e-9);
    }
  }
}

TEST(EdgeTree, BoundsTheChangeOfWindingNumbers) {
  std::mt19937 rng(4);
  Mesh mesh;
  add_rough_ball(mesh, {0, 0, 0}, 5, 0.3, 12, rng);
  remove_triangles(mesh, 0.1, rng);
  const Grid grid = fit_grid(mesh, 6);
  const QuantizedMesh quantized(mesh, grid);
  const Mesh units = quantized_mesh(mesh, grid);
  const EdgeTree edges(find_boundary_edges(quantized, {}), {});
  std::uniform_real_distribution<double> place(0, 64 * 256), offset(-1, 1);
  int finite = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3d centre{place(rng), place(rng), place(rng)};
    const double radius = 16.0 * std::pow(2, static_cast<double>(rng() % 6));
    const double steepest = edges.steepest(centre, radius, HUGE_VAL);
    finite += std::isfinite(steepest) ? 1 : 0;
    const Vec3d to = Vec3d{offset(rng), offset(rng), offset(rng)} * (radius / std::sqrt(3.0));
    const double change = winding_number(units, centre + to) - winding_number(units, centre);
    EXPECT_LE(std::abs(change - std::round(change)), steepest * length(to) + 1e-9);
  }
  EXPECT_GT(finite, 500);
}

TEST(FillByWinding, ClosedBodiesAreThoseOfParity) {
  std::mt19937 rng(5);
  Mesh mesh;
  add_rough_ball(mesh, {3, -2, 8}, 1.5, 0.6, 8, rng);
  const Grid grid = fit_grid(mesh, 6);
  const Svdag cover = build_svdag(mesh, grid).dag;
  EXPECT_EQ(fill_solid(cover.view(), mesh, grid, {SolidRule::kWinding}),
            fill_solid(cover.view(), mesh, grid, {SolidRule::kParity}));
  // Inside out.
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  EXPECT_EQ(fill_solid(cover.view(), mesh, grid, {SolidRule::kWinding}),
            fill_solid(cover.view(), mesh, grid, {SolidRule::kParity}));
}

TEST(FillByWinding, MeshesWithHolesAreThoseOfTheirWindingNumbers) {
  std::mt19937 rng(6);
  int in_holes = 0, undecided = 0;
  for (const int levels : {3, 4, 5})
    for (const double part : {0.02, 0.1, 0.3, 0.6})
      for (const double threshold : {0.5, 0.3, 0.8}) {
        Mesh mesh;
        add_rough_ball(mesh, {0, 0, 0}, 5, 0.2, 8, rng);
        remove_triangles(mesh, part, rng);
        const Filled filled = expect_winding(mesh, fit_grid(mesh, levels), threshold);
        in_holes += filled.in_holes;
        undecided += filled.undecided;
      }
  EXPECT_GT(in_holes, 10'000);
  EXPECT_LT(undecided, in_holes / 20);
}

TEST(FillByWinding, TrianglesOfBothWindings) {
  std::mt19937 rng(7);
  for (const double part : {0.02, 0.1, 0.4}) {
    Mesh mesh;
    add_rough_ball(mesh, {0, 0, 0}, 5, 0.2, 8, rng);
    flip_triangles(mesh, part, rng);
    EXPECT_GT(expect_winding(mesh, fit_grid(mesh, 5)).inside, 100);
  }
}

TEST(FillByWinding, OverlappingAndNestedBodies) {
  std::mt19937 rng(8);
  Mesh mesh;
  add_rough_ball(mesh, {0, 0, 0}, 5, 0.3, 8, rng);
  add_rough_ball(mesh, {3, 2, 1}, 4, 0.3, 8, rng);
  add_box(mesh, {-1, -1, -1}, {1, 1, 1}, false);
  for (const double threshold : {0.5, 1.5}) {
    const Filled filled = expect_winding(mesh, fit_grid(mesh, 5), threshold);
    EXPECT_GT(filled.inside, 300);
    EXPECT_EQ(filled.in_holes, 0);
  }
  // Balls that are only triangles, without a common vertex or order.
  remove_triangles(mesh, 0.2, rng);
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), rng);
  EXPECT_GT(expect_winding(mesh, fit_grid(mesh, 5)).in_holes, 100);
}

/// The winding number in a flat hole is 1/2, and its voxels lie on the lattice.
TEST(FillByWinding, ABoxWithoutALidIsFilledUpToIt) {
  Grid grid;
  grid.levels = 5;
  grid.quantization_scale = 256;
  Mesh mesh;
  add_box(mesh, {4, 4, 4}, {20, 24, 12});
  mesh.triangles.erase(mesh.triangles.begin() + 2, mesh.triangles.begin() + 4);  // z = 12
  const Svdag cover = build_svdag(mesh, grid).dag;
  const Svdag solid = fill_solid(cover.view(), mesh, grid, {SolidRule::kWinding});
  for (int x = 5; x < 19; ++x)
    for (int y = 5; y < 23; ++y) {
      EXPECT_TRUE(svdag_contains(solid.view(), {x, y, 11}, 5));
      EXPECT_FALSE(svdag_contains(solid.view(), {x, y, 12}, 5));
    }
  expect_winding(mesh, grid);
}

TEST(FillByWinding, SheetsGrowWithTheHoleAndNotWithTheGrid) {
  Mesh mesh;
  add_box(mesh, {0, 0, 0}, {1, 0.7f, 0.3f});
  // A hole of a hundredth of the side in the middle of a face of four triangles.
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  for (const Vec3f corner : {Vec3f{0.5f, 0.5f, 0.3f}, Vec3f{0.51f, 0.5f, 0.3f},
                             Vec3f{0.51f, 0.51f, 0.3f}, Vec3f{0.5f, 0.51f, 0.3f}})
    mesh.vertices.push_back(corner);
  mesh.triangles.erase(mesh.triangles.begin() + 2, mesh.triangles.begin() + 4);
  const std::uint32_t outer[] = {4, 5, 7, 6};
  for (std::uint32_t i = 0; i < 4; ++i) {
    const std::uint32_t a = outer[i], b = outer[(i + 1) % 4], c = first + i,
                        d = first + (i + 1) % 4;
    mesh.triangles.push_back({a, b, d});
    mesh.triangles.push_back({a, d, c});
  }
  const Grid grid = fit_grid(mesh, 13);
  const Svdag cover = build_svdag(mesh, grid).dag;
  const Svdag solid = fill_solid(cover.view(), mesh, grid, {SolidRule::kWinding});
  const double volume = static_cast<double>(count_svdag(solid.view()).voxels) / std::pow(8192, 3);
  EXPECT_NEAR(volume, 0.21, 0.001);
  EXPECT_TRUE(svdag_contains(solid.view(), {4130, 4130, 2400}, 13));
  EXPECT_FALSE(svdag_contains(solid.view(), {4130, 4130, 2500}, 13));
}

TEST(FillByWinding, GridsWithinAndWithoutABody) {
  Mesh mesh;
  add_box(mesh, {-10, -10, -10}, {10, 10, 10});
  mesh.triangles.pop_back();
  Grid grid;
  grid.levels = 3;
  grid.voxel_size = 0.25;
  grid.quantization_scale = 1024;
  expect_winding(mesh, grid);
  grid.origin = {11, 0, 0};
  expect_winding(mesh, grid);
}

}  // namespace
}  // namespace voxdag
