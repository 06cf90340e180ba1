/// The device's copy of a DAG that is being edited.
#include <gtest/gtest.h>

#include <random>

#include "cuda/cuda_device.hpp"
#include "cuda/like_the_cpu.hpp"
#include "cuda/pictures.hpp"
#include "support/brute_svdag.hpp"
#include "support/number_colors.hpp"
#include "support/test_rays.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/cpu/render_image.hpp"
#include "voxdag/cpu/trace_batch.hpp"
#include "voxdag/cuda/device_attributes.hpp"
#include "voxdag/cuda/render_image.hpp"
#include "voxdag/cuda/trace_batch.hpp"
#include "voxdag/edit/editable_dag.hpp"

namespace voxdag {
namespace {

using CudaEdits = OnCudaDevice;

TEST_F(CudaEdits, HitsOfEachVersionEqualTheCpu) {
  const int levels = 6;
  const Svdag base = brute_svdag(levels, random_voxels(levels, 3000, 1));
  Grid grid;
  grid.levels = levels;
  EditableDag dag(base.view(), {.history = 3, .tracks_changes = true});
  DeviceScene scene(device_, dag.snapshot().view(), dag.nodes().words_end(),
                    dag.nodes().blocks_end());
  dag.take_changes();
  std::mt19937 random(3);
  const auto number = [&] { return static_cast<double>(random() % 64); };
  TestRays make(grid, 5);
  std::vector<Ray> rays;
  for (int i = 0; i < 20'000; ++i)
    rays.push_back(make.make(static_cast<RayKind>(i % static_cast<int>(RayKind::kCount))));
  std::vector<Hit> expected(rays.size()), hits(rays.size());
  for (int i = 0; i < 12; ++i) {
    const EditShape ball = make_ball(grid, {number(), number(), number()}, 4 + number() / 4);
    i % 3 == 0 ? dag.remove(ball) : dag.add(ball);
    if (i == 8) dag.collect();
    if (i == 10) dag.undo();
    const EditSnapshot snapshot = dag.snapshot();
    scene = scene.updated(snapshot.view(), dag.nodes().words_end(), dag.nodes().blocks_end(),
                          dag.take_changes());
    const Svdag saved = snapshot.svdag();
    trace_batch(saved.view(), grid, rays, expected);
    CudaTracer(scene, grid).trace(rays, hits);
    EXPECT_EQ(hits, expected) << "edit " << i;
    trace_batch(snapshot.view(), grid, rays, hits);
    EXPECT_EQ(hits, expected) << "edit " << i << ", on the CPU";
  }
}

TEST_F(CudaEdits, PaintedColorsReachTheDevice) {
  const Svdag base = picture_scene();
  const NumberColors colors(base.view(), base.levels);
  const Grid grid = picture_grid();
  const double side = grid.side();
  EditableDag dag(colors.view(), {.tracks_changes = true});
  DeviceScene scene(device_, dag.snapshot().view(), dag.nodes().words_end(),
                    dag.nodes().blocks_end());
  DeviceAttributes attributes(scene, colors.view().attributes);
  dag.take_changes();
  for (int i = 0; i < 6; ++i) {
    const EditShape ball =
        make_ball(grid, grid.origin + Vec3d{0.15 * i, 0.5, 0.4} * side, side / 5);
    const EditPaint paint{.color = Value8{255, static_cast<std::uint8_t>(40 * i), 0}};
    i % 2 == 0 ? dag.add(ball, paint) : dag.paint(ball, paint);
    const EditSnapshot snapshot = dag.snapshot();
    scene = scene.updated(snapshot.view(), dag.nodes().words_end(), dag.nodes().blocks_end(),
                          dag.take_changes());
    attributes = attributes.updated(scene, snapshot.values().overlays, dag.values().words_end(),
                                    dag.take_value_changes());
    RenderOptions options = pictures(1)[0].options;
    options.look = snapshot.values();
    const RenderedImage expected = render_image(snapshot.view(), picture_grid(), options);
    options.look = attributes.view();
    expect_pixels_like(render_image(scene, picture_grid(), options), expected);
  }
}

}  // namespace
}  // namespace voxdag
