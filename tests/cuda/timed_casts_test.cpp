#include "voxdag/cuda/timed_casts.hpp"

#include <gtest/gtest.h>

#include "cuda/cuda_device.hpp"
#include "cuda/pictures.hpp"
#include "support/test_esvo.hpp"
#include "voxdag/render/render_plan.hpp"
#include "voxdag/render/voxel_view_samples.hpp"
#include "voxdag/trace/esvo_cast.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {
namespace {

using CudaTimedCasts = OnCudaDevice;

/// Expects casts at the device's copy to find what `nodes` of the host's find.
template <class Nodes>
void expect_hits_of_the_cpu(const DeviceScene& scene, const Nodes& nodes) {
  const RenderPlan plan(scene.host(), picture_grid(), pictures(4)[0].options);
  ViewTile tile;
  tile.width = plan.setup().camera.width;
  tile.height = plan.setup().camera.height;
  std::vector<CastRay> rays;
  std::vector<std::uint8_t> expected;
  for (int pixel = 0; pixel < tile.width * tile.height; ++pixel) {
    rays.push_back(primary_ray(plan.setup(), tile, pixel));
    CellHit cell;
    expected.push_back(cast(nodes, rays.back().ray, rays.back().stop, cell));
  }
  const TimedCasts casts(scene, rays);
  std::vector<std::uint8_t> closest(rays.size()), any(rays.size());
  EXPECT_GT(casts.closest(), 0);
  casts.copy_hits(closest);
  EXPECT_EQ(closest, expected);
  EXPECT_GT(casts.any(), 0);
  casts.copy_hits(any);
  EXPECT_EQ(any, expected);
  EXPECT_GT(TimedBeams(scene, plan.setup()).run(), 0);
}

TEST_F(CudaTimedCasts, FindWhatTheCpuFinds) {
  const Svdag dag = picture_scene();
  expect_hits_of_the_cpu(DeviceScene(device_, dag.view()), SvdagNodes(dag.view()));
  std::mt19937 rng(4);
  const Esvo esvo = TestEsvoAssembler(3, 4).assemble(*random_octree(rng, 0, 6), 6);
  expect_hits_of_the_cpu(DeviceScene(device_, esvo.view()), ContourNodes(esvo.view()));
  expect_hits_of_the_cpu(DeviceScene(device_, esvo.view(), DeviceLayout::kCubes),
                         EsvoNodes(esvo.view()));
}

}  // namespace
}  // namespace voxdag
