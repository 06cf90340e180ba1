#include "voxdag/cuda/timed_casts.hpp"

#include <gtest/gtest.h>

#include "cuda/cuda_device.hpp"
#include "cuda/pictures.hpp"
#include "voxdag/render/render_plan.hpp"
#include "voxdag/render/voxel_view_samples.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {
namespace {

using CudaTimedCasts = OnCudaDevice;

TEST_F(CudaTimedCasts, FindWhatTheCpuFinds) {
  const Svdag dag = picture_scene();
  const DeviceScene device_dag(device_, dag.view());
  const RenderPlan plan(dag.view(), picture_grid(), pictures(4)[0].options);
  ViewTile tile;
  tile.width = plan.setup().camera.width;
  tile.height = plan.setup().camera.height;
  std::vector<CastRay> rays;
  std::vector<std::uint8_t> expected;
  for (int pixel = 0; pixel < tile.width * tile.height; ++pixel) {
    rays.push_back(primary_ray(plan.setup(), tile, pixel));
    CellHit cell;
    expected.push_back(cast(SvdagNodes(dag.view()), rays.back().ray, rays.back().stop, cell));
  }
  const TimedCasts casts(device_dag, rays);
  std::vector<std::uint8_t> closest(rays.size()), any(rays.size());
  EXPECT_GT(casts.closest(), 0);
  casts.copy_hits(closest);
  EXPECT_EQ(closest, expected);
  EXPECT_GT(casts.any(), 0);
  casts.copy_hits(any);
  EXPECT_EQ(any, expected);
  EXPECT_GT(TimedBeams(device_dag, plan.setup()).run(), 0);
}

}  // namespace
}  // namespace voxdag
