#include "voxdag/mesh_view/mesh_in_grid.hpp"

#include <gtest/gtest.h>

#include "meshes.hpp"
#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

class MeshInGrid : public testing::Test {
 protected:
  std::string failure(const Mesh& mesh) const {
    try {
      check_mesh_in_grid(mesh, dag_.view(), grid_);
      return {};
    } catch (const Error& error) {
      return error.what();
    }
  }

  Mesh mesh_ = random_mesh(300, 1, {50, -20, 7});
  Grid grid_ = fit_grid(mesh_, 8);
  Svdag dag_ = build_svdag(mesh_, grid_).dag;
};

TEST_F(MeshInGrid, TheMeshOfTheBuildPasses) { EXPECT_EQ(failure(mesh_), ""); }

TEST_F(MeshInGrid, AMeshCutOffByTheGridPasses) {
  grid_.origin = grid_.origin + Vec3d{1, 1, 1} * (grid_.voxel_size * 100);
  dag_ = build_svdag(mesh_, grid_).dag;
  EXPECT_EQ(failure(mesh_), "");
}

TEST_F(MeshInGrid, AMeshElsewhereIsRefused) {
  for (Vec3f& vertex : mesh_.vertices) vertex = vertex - Vec3f{50, -20, 7};
  EXPECT_NE(failure(mesh_).find("is not in the grid"), std::string::npos) << failure(mesh_);
}

TEST_F(MeshInGrid, AnotherMeshOfTheSamePlaceIsRefused) {
  const std::string text = failure(random_mesh(300, 2, {50, -20, 7}));
  EXPECT_NE(text.find("not built from this mesh"), std::string::npos) << text;
}

}  // namespace
}  // namespace voxdag
