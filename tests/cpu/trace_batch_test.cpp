#include "voxdag/cpu/trace_batch.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "support/brute_svdag.hpp"
#include "support/with_threads.hpp"
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {
namespace {

std::vector<Ray> random_rays(std::size_t count) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<float> component(-1, 1);
  const auto vector = [&] { return Vec3f{component(rng), component(rng), component(rng)}; };
  std::vector<Ray> rays(count);
  for (Ray& ray : rays) {
    ray.origin = vector() * 2.0f;
    ray.direction = vector();
    ray.t_max = std::numeric_limits<float>::infinity();
  }
  return rays;
}

TEST(TraceBatch, EqualsSingleCastsForAnyNumberOfThreads) {
  const int levels = 6;
  const Svdag dag = brute_svdag(levels, random_voxels(levels, 5000, 2));
  Grid grid;
  grid.levels = levels;
  grid.origin = {-1, -1, -1};
  grid.voxel_size = 2.0 / 64;
  const std::vector<Ray> rays = random_rays(10'001);
  std::vector<Hit> expected;
  for (const Ray& ray : rays) expected.push_back(closest_hit(SvdagNodes(dag.view()), grid, ray));
  for (const int threads : {1, 2, 7}) {
    std::vector<Hit> hits(rays.size());
    with_threads(threads, [&] { trace_batch(dag.view(), grid, rays, hits); });
    EXPECT_EQ(hits, expected) << threads << " threads";
  }
}

TEST(TraceBatch, NoRaysAreNoWork) { trace_batch(Svdag{}.view(), Grid{}, {}, {}); }

TEST(TraceBatch, StopsWhenCancelled) {
  Progress progress;
  progress.cancel();
  const std::vector<Ray> rays = random_rays(10);
  std::vector<Hit> hits(rays.size());
  EXPECT_THROW(trace_batch(Svdag{}.view(), Grid{}, rays, hits, &progress), Cancelled);
}

}  // namespace
}  // namespace voxdag
