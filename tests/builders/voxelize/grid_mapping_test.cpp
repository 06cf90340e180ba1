#include "voxdag/builders/voxelize/grid_mapping.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

Mesh one_triangle(Vec3f a, Vec3f b, Vec3f c) { return {{a, b, c}, {{0, 1, 2}}, {}, {}}; }

TEST(FitGrid, TheLongestSideSpansAllVoxels) {
  const Mesh mesh = one_triangle({-1, 2, 3}, {7, 2, 3}, {0, 5, 3.5f});
  const Grid grid = fit_grid(mesh, 10);
  EXPECT_EQ(grid.origin, (Vec3d{-1, 2, 3}));
  EXPECT_EQ(grid.quantization_scale, (1024 * 256 - 1) / 8.0);
  const QuantizedMesh quantized(mesh, grid);
  EXPECT_EQ(quantized.triangle(0).x, (Vec3i{0, 0, 0}));
  EXPECT_EQ(quantized.triangle(0).y, (Vec3i{1024 * 256 - 1, 0, 0}));
}

TEST(FitGrid, UnreferencedVerticesDoNotCount) {
  Mesh mesh = one_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  mesh.vertices.push_back({1000, 1000, 1000});
  EXPECT_EQ(fit_grid(mesh, 4).origin, (Vec3d{0, 0, 0}));
  EXPECT_EQ(fit_grid(mesh, 4).quantization_scale, 16 * 256 - 1.0);
}

TEST(FitGrid, APointGetsAGridToo) {
  const Mesh mesh = one_triangle({5, 5, 5}, {5, 5, 5}, {5, 5, 5});
  EXPECT_EQ(fit_grid(mesh, 4).voxel_size, 1.0);
}

TEST(FitGrid, RefusesWhatItCannotMake) {
  const Mesh mesh = one_triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  EXPECT_THROW(fit_grid(mesh, 1), Error);
  EXPECT_THROW(fit_grid(mesh, 21), Error);
  EXPECT_THROW(fit_grid(Mesh{}, 8), Error);
}

TEST(GridFromVoxelSize, IsTheSmallestThatHoldsTheMesh) {
  const Mesh mesh = one_triangle({0, 0, 0}, {1.5f, 0, 0}, {0, 1, 0});
  EXPECT_EQ(grid_from_voxel_size(mesh, 0.1).levels, 4);      // voxels 0..15
  EXPECT_EQ(grid_from_voxel_size(mesh, 0.09375).levels, 5);  // the far vertex is in voxel 16
  EXPECT_EQ(grid_from_voxel_size(mesh, 0.1).voxel_size, 0.1);
  EXPECT_THROW(grid_from_voxel_size(mesh, 0), Error);
  EXPECT_THROW(grid_from_voxel_size(mesh, -1), Error);
  EXPECT_THROW(grid_from_voxel_size(mesh, std::numeric_limits<double>::quiet_NaN()), Error);
  EXPECT_THROW(grid_from_voxel_size(mesh, 1e-7), Error);
}

TEST(GridFromBounds, PlacesTheGridAtTheBounds) {
  const Grid grid = grid_from_bounds(Box3d{{-4, 0, 4}, {4, 2, 5}}, 5);
  EXPECT_EQ(grid.origin, (Vec3d{-4, 0, 4}));
  EXPECT_EQ(grid.voxel_size, 0.25);
  EXPECT_THROW(grid_from_bounds(Box3d{{1, 1, 1}, {1, 1, 1}}, 5), Error);
  EXPECT_THROW(grid_from_bounds(Box3d{{1, 1, 1}, {0, 2, 2}}, 5), Error);
}

TEST(QuantizedMesh, RoundsHalfAwayFromZero) {
  const Grid grid = grid_from_bounds(Box3d{{0, 0, 0}, {16, 16, 16}}, 4);  // 256 units a unit
  const Mesh mesh = one_triangle({0.5f / 256, 1.5f / 256, -0.5f / 256}, {0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(QuantizedMesh(mesh, grid).triangle(0).x, (Vec3i{1, 2, -1}));
}

TEST(QuantizedMesh, ClipsWhatIsFarOutsideTheGrid) {
  const Grid grid = grid_from_bounds(Box3d{{0, 0, 0}, {16, 16, 16}}, 4);
  const Mesh mesh = one_triangle({-1e9f, 5, 0}, {1e9f, 5, 0}, {0, 5, 1e9f});
  const QuantizedMesh quantized(mesh, grid);
  EXPECT_FALSE(quantized.in_range(0));
  ASSERT_GT(quantized.triangle_count(), 1u);
  for (std::size_t i = 1; i < quantized.triangle_count(); ++i)
    for (int corner = 0; corner < 3; ++corner)
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_LE(std::abs(quantized.triangle(i)[corner][axis]), kMaxUnits);
  EXPECT_EQ(quantized.triangle(1).x.y, 5 * 256);
}

}  // namespace
}  // namespace voxdag
