/// Tests pictures of triangles with the voxels' light. At every resolution, a mesh must not shadow
/// itself wrongly and must not let light through.
#include <gtest/gtest.h>

#include "meshes.hpp"
#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/cpu/render_image.hpp"
#include "voxdag/mesh_view/mesh_view_source.hpp"

namespace voxdag {
namespace {

class MeshPrimary : public testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (!VOXDAG_HAS_EMBREE) GTEST_SKIP() << "built without Embree";
  }

  RenderedImage render(const Mesh& mesh, RenderOptions options) const {
    options.width = 96;
    options.height = 64;
    options.sun_degrees = 0;
    options.occlusion_distance = 0.5;
    const Grid grid = fit_grid(mesh, GetParam());
    const Svdag dag = build_svdag(mesh, grid).dag;
    const MeshViewSource source(mesh);
    return render_image(dag.view(), grid, options, {}, &source);
  }
};

RenderOptions from(Vec3d eye, Vec3d target, Vec3d sun) {
  RenderOptions options;
  options.view.eye = eye;
  options.view.target = target;
  options.view.up = Vec3d{0.1, 1, 0.05};
  options.sun = sun;
  return options;
}

TEST_P(MeshPrimary, AConvexBodyDoesNotShadowItself) {
  for (const Mesh& mesh : {cube_mesh(), disordered_sphere_mesh(48)}) {
    const Vec3d sun{0.5, 0.8, 0.4};
    const RenderedImage image = render(mesh, from({2.2, 1.9, 2.8}, {}, sun));
    int hits = 0;
    for (std::size_t i = 0; i < image.depth.size(); ++i) {
      if (std::isinf(image.depth[i])) continue;
      ++hits;
      // Facets of the sphere are flat. Within a voxel of their edges, a few of the 64 rays meet a
      // neighbour that rises 1 or 2 degrees above the horizon.
      EXPECT_GT(image.occlusion[i], 0.93f) << i;
      const Vec3f direction = normalized(static_cast<Vec3f>(sun));
      if (!(dot(image.normal[i], direction) > 0.1f)) continue;
      EXPECT_EQ(image.shadow[i], 1) << i;
    }
    EXPECT_GT(hits, 500);
  }
}

TEST_P(MeshPrimary, AHighlightIsWhereTheNormalHalvesTheAngle) {
  const Vec3d sun{0.5, 0.8, 0.4};
  RenderOptions options = from({2.2, 1.9, 2.8}, {}, sun);
  const Mesh sphere = disordered_sphere_mesh(48);
  const RenderedImage dull = render(sphere, options);
  options.specular = {0.5f, 200};
  const RenderedImage shiny = render(sphere, options);
  std::size_t brightest = 0;
  const auto highlight = [&](std::size_t i) { return shiny.radiance[i].y - dull.radiance[i].y; };
  for (std::size_t i = 0; i < shiny.depth.size(); ++i)
    if (highlight(i) > highlight(brightest)) brightest = i;
  EXPECT_GT(highlight(brightest), 1);
  // The viewer is far away in comparison with the sphere; a pixel is about 3 degrees of it.
  const Vec3d half = normalized(normalized(sun) + normalized(Vec3d{2.2, 1.9, 2.8}));
  EXPECT_GT(dot(static_cast<Vec3d>(shiny.normal[brightest]), half), 0.99);
}

TEST_P(MeshPrimary, NoSunShinesIntoAClosedRoom) {
  for (const Mesh& mesh : {cube_mesh(), disordered_sphere_mesh(48)})
    for (const Vec3d target : {Vec3d{1, 1, 1}, Vec3d{-1, -1, 0.9}, Vec3d{0.2, -1, -1}}) {
      const RenderedImage image = render(mesh, from({0.1, 0.2, -0.15}, target, {0.3, 1, 0.4}));
      for (std::size_t i = 0; i < image.depth.size(); ++i) {
        ASSERT_FALSE(std::isinf(image.depth[i])) << i;
        // Where the sun is below the surface or the facet, the pass is 1, because no light is lost.
        // Facets differ from the smooth normal by less than 4 degrees.
        if (!(dot(image.normal[i], Vec3f{0.27f, 0.9f, 0.36f}) > 0.1f)) continue;
        EXPECT_EQ(image.shadow[i], 0) << i;
      }
    }
}

TEST_P(MeshPrimary, CornersOfARoomAreDarkerButNotBlack) {
  const RenderedImage image =
      render(cube_mesh(), from({0.1, 0.2, -0.15}, {1, 1, 1}, {0.3, 1, 0.4}));
  for (std::size_t i = 0; i < image.depth.size(); ++i) EXPECT_GT(image.occlusion[i], 0.1f) << i;
}

TEST_P(MeshPrimary, CrevicesFinerThanVoxelsAreNotBlack) {
  // Two walls that meet at 45 degrees, seen through the gap between them.
  constexpr float kSide = 2, kHalfWidth = 0.828f;
  Mesh mesh;
  mesh.vertices = {{-kSide, 0, 0},           {kSide, 0, 0},
                   {-kSide, kHalfWidth, 2},  {kSide, kHalfWidth, 2},
                   {-kSide, -kHalfWidth, 2}, {kSide, -kHalfWidth, 2}};
  mesh.triangles = {{0, 1, 3}, {0, 3, 2}, {0, 1, 5}, {0, 5, 4}};
  RenderOptions options = from({0.3, 0.1, 4}, {}, {0, 0, 1});
  options.view.vertical_fov_degrees = 1;
  const RenderedImage image = render(mesh, options);
  for (std::size_t i = 0; i < image.depth.size(); ++i) {
    ASSERT_FALSE(std::isinf(image.depth[i])) << i;
    EXPECT_GT(image.occlusion[i], 0.01f) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Levels, MeshPrimary, testing::Values(7, 9, 11),
                         [](const auto& levels) { return std::to_string(1 << levels.param); });

}  // namespace
}  // namespace voxdag
