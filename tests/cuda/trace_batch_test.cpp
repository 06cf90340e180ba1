#include "voxdag/cuda/trace_batch.hpp"

#include <gtest/gtest.h>

#include "cuda/cubes.hpp"
#include "cuda/cuda_device.hpp"
#include "support/brute_svdag.hpp"
#include "support/test_esvo.hpp"
#include "support/test_rays.hpp"
#include "voxdag/cpu/trace_batch.hpp"

namespace voxdag {
namespace {

using CudaTrace = OnCudaDevice;

Grid test_grid(int levels) {
  Grid grid;
  grid.levels = levels;
  grid.origin = {-1, -2, 0.1};
  grid.voxel_size = 0.3;
  return grid;
}

std::vector<Ray> rays_of_every_kind(const Grid& grid, std::size_t count, unsigned seed) {
  TestRays make(grid, seed);
  std::vector<Ray> rays;
  for (std::size_t i = 0; i < count; ++i)
    rays.push_back(make.make(static_cast<RayKind>(i % static_cast<std::size_t>(RayKind::kCount))));
  return rays;
}

void expect_hits_of_the_cpu(const CudaDevice& device, int levels, int voxels, std::size_t count) {
  const Svdag dag = brute_svdag(levels, random_voxels(levels, voxels, 3));
  const Grid grid = test_grid(levels);
  const std::vector<Ray> rays = rays_of_every_kind(grid, count, 7);
  std::vector<Hit> expected(count), hits(count);
  trace_batch(dag.view(), grid, rays, expected);
  for (const DeviceLayout layout : {DeviceLayout::kPaper, DeviceLayout::kTop}) {
    CudaTracer(DeviceScene(device, dag.view(), layout), grid).trace(rays, hits);
    std::size_t wrong = 0;
    for (std::size_t i = 0; i < count; ++i) wrong += hits[i] == expected[i] ? 0 : 1;
    EXPECT_EQ(wrong, 0u) << "of " << count << " rays in " << levels << " levels";
  }
}

TEST_F(CudaTrace, EqualsTheCpuForEveryRay) {
  for (const int levels : {2, 3, 6, 9})
    expect_hits_of_the_cpu(device_, levels, levels == 2 ? 5 : 4000, 200'000);
}

TEST_F(CudaTrace, EqualsTheCpuForEveryRayAtAnEsvo) {
  for (const int levels : {2, 4, 6}) {
    std::mt19937 rng(static_cast<unsigned>(levels));
    const Esvo esvo = TestEsvoAssembler(3, 1).assemble(*random_octree(rng, 0, levels), levels);
    const Grid grid = test_grid(levels);
    const std::vector<Ray> rays = rays_of_every_kind(grid, 100'000, 8);
    std::vector<Hit> expected(rays.size()), hits(rays.size());
    trace_batch(esvo.view(), grid, rays, expected);
    CudaTracer(DeviceScene(device_, esvo.view()), grid).trace(rays, hits);
    EXPECT_EQ(hits, expected);
    CudaTracer(DeviceScene(device_, esvo.view(), DeviceLayout::kCubes), grid).trace(rays, hits);
    const std::vector<Hit> of_cubes = trace_cubes(esvo.view(), grid, rays);
    EXPECT_EQ(hits, of_cubes);
    EXPECT_NE(of_cubes, expected);
  }
}

TEST_F(CudaTrace, EqualsTheCpuOverManyBlocks) {
  expect_hits_of_the_cpu(device_, 7, 20'000, 1'500'001);
}

TEST_F(CudaTrace, EmptyDagsAndNoRays) {
  const Svdag dag;
  const CudaTracer tracer(DeviceScene(device_, dag.view()), Grid{});
  tracer.trace({}, {});
  const std::vector<Ray> rays = rays_of_every_kind(Grid{}, 100, 1);
  std::vector<Hit> hits(rays.size());
  tracer.trace(rays, hits);
  for (const Hit& hit : hits) EXPECT_EQ(hit, Hit{});
}

TEST_F(CudaTrace, StopsWhenCancelledAndWorksAgain) {
  const Svdag dag = brute_svdag(4, random_voxels(4, 50, 3));
  const Grid grid = test_grid(4);
  const std::vector<Ray> rays = rays_of_every_kind(grid, 1000, 1);
  std::vector<Hit> expected(rays.size()), hits(rays.size());
  const CudaTracer tracer(DeviceScene(device_, dag.view()), grid);
  Progress progress;
  progress.cancel();
  EXPECT_THROW(tracer.trace(rays, hits, &progress), Cancelled);
  tracer.trace(rays, hits);
  trace_batch(dag.view(), grid, rays, expected);
  EXPECT_EQ(hits, expected);
}

}  // namespace
}  // namespace voxdag
