// Solid fill against winding numbers in double precision: the centre of a voxel that no triangle
// meets is so far from the surface that they are near whole numbers.
#include "voxdag/builders/solid/fill_solid.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "bodies.hpp"
#include "support/brute_svdag.hpp"
#include "support/error_of.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/algebra/components.hpp"
#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/solid/winding/winding_point.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"
#include "voxdag/stored/svdag/svdag_lookup.hpp"

namespace voxdag {
namespace {

/// Expects that fill_solid() adds the voxels around whose centres the surface winds an odd number
/// of times, leaves out those that the body only touches, and changes no others. Returns how many
/// it adds.
int expect_parity(const Mesh& mesh, const Grid& grid) {
  const Svdag cover = build_svdag(mesh, grid).dag;
  const Svdag solid = fill_solid(cover.view(), mesh, grid, {SolidRule::kParity});
  int inside = 0;
  const auto is_inside = [&](Vec3i v) {
    const Vec3d centre = grid.to_world(static_cast<Vec3d>(v) + Vec3d{0.5, 0.5, 0.5});
    return std::llround(winding_number(mesh, centre)) % 2 != 0;
  };
  const TouchedVoxels touched(mesh, grid, is_inside);
  const std::vector<Vec3i> expected = voxels_where(grid.levels, [&](Vec3i v) {
    if (svdag_contains(cover.view(), v, grid.levels)) return !touched.contains(v);
    const Vec3d centre = grid.to_world(static_cast<Vec3d>(v) + Vec3d{0.5, 0.5, 0.5});
    const double winding = winding_number(mesh, centre);
    EXPECT_NEAR(winding, std::round(winding), 0.01);
    const bool is_odd = is_inside(v);
    inside += is_odd ? 1 : 0;
    return is_odd;
  });
  EXPECT_EQ(solid, brute_svdag(grid.levels, expected));
  return inside;
}

TEST(FillSolid, RoughBodiesAreThoseOfTheirWindingNumbers) {
  std::mt19937 rng(2);
  int inside = 0;
  for (const int levels : {3, 4, 5})
    for (const double noise : {0.1, 0.5, 0.9}) {
      Mesh mesh;
      add_rough_ball(mesh, {3, -2, 8}, 1.5, noise, 6, rng);
      inside += expect_parity(mesh, fit_grid(mesh, levels));
    }
  EXPECT_GT(inside, 5000);
}

TEST(FillSolid, NestedAndOverlappingBodiesAlternate) {
  std::mt19937 rng(3);
  Mesh nested;
  add_rough_ball(nested, {0, 0, 0}, 5, 0.1, 8, rng);
  add_rough_ball(nested, {0, 0, 0}, 3, 0.1, 8, rng);
  add_box(nested, {-1, -1, -1}, {1, 1, 1}, false);
  EXPECT_GT(expect_parity(nested, fit_grid(nested, 5)), 100);
  Mesh overlapping;
  add_rough_ball(overlapping, {0, 0, 0}, 5, 0.3, 8, rng);
  add_rough_ball(overlapping, {3, 2, 1}, 4, 0.3, 8, rng);
  add_box(overlapping, {-4, -1, -1}, {6, 1, 1.5f});
  EXPECT_GT(expect_parity(overlapping, fit_grid(overlapping, 5)), 100);
}

/// Corners, edges and faces lie at the sides and the centres of voxels, and so do the rays.
TEST(FillSolid, BodiesOnTheLatticeAreExact) {
  Grid grid;
  grid.levels = 4;
  grid.quantization_scale = 256;
  for (const float shift : {0.0f, 0.5f, 0.25f}) {
    Mesh mesh;
    const Vec3f by{shift, shift, shift};
    add_box(mesh, Vec3f{1, 1, 1} + by, Vec3f{7, 6, 5} + by);
    // Two boxes that share a face, of which each has a copy.
    add_box(mesh, Vec3f{8, 1, 1} + by, Vec3f{12, 8, 8} + by);
    add_box(mesh, Vec3f{8, 8, 1} + by, Vec3f{12, 14, 8} + by);
    // A pyramid whose edges run through the centres.
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const Vec3f corner : {Vec3f{1, 8, 8}, Vec3f{7, 8, 8}, Vec3f{1, 14, 8}, Vec3f{1, 8, 14}})
      mesh.vertices.push_back(corner + by);
    for (const Triangle& t :
         {Triangle{0, 2, 1}, Triangle{0, 1, 3}, Triangle{0, 3, 2}, Triangle{1, 2, 3}})
      mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
    EXPECT_GT(expect_parity(mesh, grid), 150) << shift;
  }
}

TEST(FillSolid, PocketsOfEqualNodesAreToldApart) {
  // Closed pockets of one voxel: those between the walls of boxes within boxes are not inside.
  Grid grid;
  grid.levels = 5;
  grid.quantization_scale = 256;
  Mesh mesh;
  for (int i = 0; i < 4; ++i) {
    const Vec3f at{static_cast<float>(8 * i), 0, 0};
    add_box(mesh, at + Vec3f{0.5f, 0.5f, 0.5f}, at + Vec3f{2.5f, 2.5f, 2.5f});
    // An inner box just inside the walls makes the same voxels, but an even parity.
    if (i % 2 == 0) add_box(mesh, at + Vec3f{0.75f, 0.75f, 0.75f}, at + Vec3f{2.25f, 2.25f, 2.25f});
  }
  EXPECT_EQ(expect_parity(mesh, grid), 2);
}

/// A million random points, against the planes of the tetrahedra that the mesh consists of.
TEST(FillSolid, AMillionPointsAreInsideAnOddNumberOfTetrahedra) {
  std::mt19937 rng(6);
  std::uniform_real_distribution<double> place(0, 1);
  Mesh mesh;
  for (int i = 0; i < 12; ++i) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int corner = 0; corner < 4; ++corner)
      mesh.vertices.push_back(Vec3f(Vec3d{place(rng), place(rng), place(rng)}));
    for (const Triangle& t :
         {Triangle{0, 1, 2}, Triangle{0, 3, 1}, Triangle{0, 2, 3}, Triangle{1, 3, 2}})
      mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  const Grid grid = fit_grid(mesh, 10);
  const Svdag cover = build_svdag(mesh, grid).dag;
  const Svdag solid = fill_solid(cover.view(), mesh, grid, {SolidRule::kParity});
  const auto is_in_tetrahedron = [&](std::size_t first, Vec3d p) {
    for (std::size_t corner = 0; corner < 4; ++corner) {
      const auto at = [&](std::size_t i) {
        return static_cast<Vec3d>(mesh.vertices[first + (corner + i) % 4]);
      };
      const Vec3d normal = cross(at(2) - at(1), at(3) - at(1));
      if ((dot(normal, p - at(1)) > 0) != (dot(normal, at(0) - at(1)) > 0)) return false;
    }
    return true;
  };
  int inside = 0;
  for (int i = 0; i < 1'000'000; ++i) {
    const Vec3i v{static_cast<std::int32_t>(rng() % 1024), static_cast<std::int32_t>(rng() % 1024),
                  static_cast<std::int32_t>(rng() % 1024)};
    if (svdag_contains(cover.view(), v, grid.levels)) continue;
    const Vec3d centre = grid.to_world(static_cast<Vec3d>(v) + Vec3d{0.5, 0.5, 0.5});
    bool is_odd = false;
    for (std::size_t first = 0; first < mesh.vertices.size(); first += 4)
      is_odd ^= is_in_tetrahedron(first, centre);
    ASSERT_EQ(svdag_contains(solid.view(), v, grid.levels), is_odd);
    inside += is_odd ? 1 : 0;
  }
  EXPECT_GT(inside, 10'000);
}

TEST(FillSolid, TheVolumeIsTheIntegralWithinTheSurface) {
  std::mt19937 rng(7);
  Mesh mesh;
  add_rough_ball(mesh, {1, 2, 3}, 4, 0.3, 20, rng);
  double integral = 0;
  for (const Triangle& t : mesh.triangles)
    integral += dot(static_cast<Vec3d>(mesh.vertices[t[0]]),
                    cross(static_cast<Vec3d>(mesh.vertices[t[1]]),
                          static_cast<Vec3d>(mesh.vertices[t[2]]))) /
                6;
  const Grid grid = fit_grid(mesh, 9);
  const Svdag cover = build_svdag(mesh, grid).dag;
  const Svdag solid = fill_solid(cover.view(), mesh, grid, {SolidRule::kParity});
  const double voxel = std::pow(grid.voxel_size, 3);
  const double all = voxel * static_cast<double>(count_svdag(solid.view()).voxels),
               surface = voxel * static_cast<double>(count_svdag(cover.view()).voxels);
  EXPECT_GE(all, std::abs(integral));
  EXPECT_LE(all - surface, std::abs(integral));
}

TEST(FillSolid, AGridInsideABodyIsFull) {
  Mesh mesh;
  add_box(mesh, {-10, -10, -10}, {10, 10, 10});
  Grid grid;
  grid.levels = 3;
  grid.voxel_size = 0.25;
  grid.quantization_scale = 1024;
  EXPECT_EQ(expect_parity(mesh, grid), 512);
}

TEST(FillSolid, AGridThatCutsABodyIsFilledUpToItsSides) {
  Mesh mesh;
  add_box(mesh, {-10, -10, 1.1f}, {3.3f, 10, 10});
  Grid grid;
  grid.levels = 4;
  grid.voxel_size = 0.5;
  grid.quantization_scale = 512;
  EXPECT_GT(expect_parity(mesh, grid), 500);
}

Grid lattice(int levels) {
  Grid grid;
  grid.levels = levels;
  grid.quantization_scale = 256;
  return grid;
}

std::uint64_t solid_voxels(const Mesh& mesh, const Grid& grid, const SolidOptions& options) {
  const Svdag cover = build_svdag(mesh, grid).dag;
  return count_svdag(fill_solid(cover.view(), mesh, grid, options).view()).voxels;
}

TEST(FillSolid, ABoxBetweenVoxelsHasItsVolume) {
  for (const SolidRule rule : {SolidRule::kParity, SolidRule::kWinding}) {
    Mesh mesh;
    add_box(mesh, {4, 4, 4}, {12, 12, 12});
    EXPECT_EQ(solid_voxels(mesh, lattice(4), {rule}), 512u);
    // A box beside it, with the same face.
    add_box(mesh, {12, 4, 4}, {14, 12, 12});
    EXPECT_EQ(solid_voxels(mesh, lattice(4), {rule}), 512u + 128);
  }
}

TEST(FillSolid, ASheetBetweenVoxelsStays) {
  Mesh mesh;
  add_box(mesh, {4, 4, 4}, {8, 8, 4});  // closed, without a volume
  EXPECT_EQ(solid_voxels(mesh, lattice(4), {SolidRule::kParity}), 25u);
}

TEST(FillSolid, ByCentresBodiesThatTouchShareNoVoxel) {
  for (const SolidRule rule : {SolidRule::kParity, SolidRule::kWinding})
    for (const float at : {2.0f, 2.25f, 2.5f, 2.75f}) {
      const SolidOptions by_centre{rule, 0.5, true};
      Mesh left, right;
      add_box(left, {at, at, at}, {at + 4, at + 3, at + 5});
      add_box(right, {at + 4, at, at}, {at + 9, at + 3, at + 5});
      EXPECT_EQ(solid_voxels(left, lattice(4), by_centre), 4u * 3 * 5) << at;
      EXPECT_EQ(solid_voxels(right, lattice(4), by_centre), 5u * 3 * 5) << at;
    }
}

TEST(FillSolid, TheRuleOfCentresIsThatOfWindingNumbers) {
  std::mt19937 rng(8);
  Mesh mesh;
  add_rough_ball(mesh, {16, 16, 16}, 14, 0.5, 6, rng);
  for (Vec3f& vertex : mesh.vertices)
    for (int axis = 0; axis < 3; ++axis) vertex[axis] = std::round(vertex[axis] * 256) / 256;
  const Grid grid = lattice(5);
  const Svdag cover = build_svdag(mesh, grid).dag;
  for (const SolidRule rule : {SolidRule::kParity, SolidRule::kWinding}) {
    const Svdag solid = fill_solid(cover.view(), mesh, grid, {rule, 0.5, true});
    int unclear = 0;
    const std::vector<Vec3i> expected = voxels_where(grid.levels, [&](Vec3i v) {
      // Winding numbers are those of a point a little beside the centre.
      const Vec3d point = rule == SolidRule::kWinding
                              ? winding_point(v, 0) * (1.0 / kSubvoxels)
                              : static_cast<Vec3d>(v) + Vec3d{0.5, 0.5, 0.5};
      const Vec3d centre = grid.to_world(point);
      const Vec3d step{1e-6, 2e-6, 3e-6};
      const bool is_inside = std::abs(winding_number(mesh, centre - step)) > 0.5;
      if (is_inside == (std::abs(winding_number(mesh, centre + step)) > 0.5)) return is_inside;
      ++unclear;  // The centre is on the surface, but for rounding.
      return svdag_contains(solid.view(), v, grid.levels);
    });
    EXPECT_EQ(solid, brute_svdag(grid.levels, expected));
    EXPECT_LT(unclear, 20);
  }
  EXPECT_NE(error_of([&] {
              fill_solid(cover.view(), mesh, grid, {SolidRule::kFlood, 0.5, true});
            }),
            "");
}

TEST(FillSolid, FloodFillsWhatIsEnclosed) {
  std::mt19937 rng(4);
  Mesh mesh;
  add_rough_ball(mesh, {0, 0, 0}, 5, 0.2, 8, rng);
  add_rough_ball(mesh, {0, 0, 0}, 3, 0.2, 8, rng);
  const Grid grid = fit_grid(mesh, 5);
  const Svdag cover = build_svdag(mesh, grid).dag;
  const Svdag flood = fill_solid(cover.view(), mesh, grid, {SolidRule::kFlood});
  EXPECT_EQ(flood, fill_cavities(cover.view()));
  EXPECT_NE(flood, fill_solid(cover.view(), mesh, grid, {SolidRule::kParity}));
}

TEST(FillSolid, AnOpenMeshIsRefused) {
  Mesh mesh;
  add_box(mesh, {0, 0, 0}, {1, 1, 1});
  mesh.triangles.pop_back();
  const Grid grid = fit_grid(mesh, 4);
  const Svdag cover = build_svdag(mesh, grid).dag;
  const std::string error =
      error_of([&] { fill_solid(cover.view(), mesh, grid, {SolidRule::kParity}); });
  EXPECT_NE(error.find("the mesh is not closed: 3 edges belong to an odd number of triangles"),
            std::string::npos)
      << error;
}

TEST(FillSolid, HugeGridsTakeNoLongerThanTheirSurface) {
  Mesh mesh;
  add_box(mesh, {0, 0, 0}, {1, 0.7f, 0.3f});
  const Grid grid = fit_grid(mesh, 16);
  const Svdag cover = build_svdag(mesh, grid).dag;
  const Svdag solid = fill_solid(cover.view(), mesh, grid, {SolidRule::kParity});
  EXPECT_TRUE(svdag_contains(solid.view(), {30'000, 20'000, 10'000}, 16));
  EXPECT_FALSE(svdag_contains(solid.view(), {30'000, 20'000, 20'000}, 16));
}

}  // namespace
}  // namespace voxdag
