// Published counts of real scenes. The folder that VOXDAG_SCENES names has them.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/dag/check_cover.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"

namespace voxdag {
namespace {

struct Reference {
  int levels;
  std::uint64_t voxels, svo_nodes, dag_nodes, dag_bytes;
};

// Counted by an independent brute-force program with the same definition of the cover.
constexpr Reference kSponza[] = {
    {11, 39'553'439, 12'677'367, 171'432, 2'905'104},
    {12, 159'037'076, 52'230'809, 484'570, 9'096'816},
    {13, 637'338'419, 211'268'242, 1'328'218, 26'816'944},
};

std::filesystem::path scene(const char* name) {
  const char* folder = std::getenv("VOXDAG_SCENES");
  return folder == nullptr ? std::filesystem::path() : std::filesystem::path(folder) / name;
}

class CrytekSponza : public testing::TestWithParam<Reference> {};

TEST_P(CrytekSponza, HasTheReferenceCounts) {
  const std::filesystem::path path = scene("crytek_sponza/sponza.obj");
  if (path.empty() || !std::filesystem::exists(path))
    GTEST_SKIP() << "VOXDAG_SCENES names no folder with crytek_sponza/sponza.obj";
  const Reference& expected = GetParam();
  const Mesh mesh = read_mesh(path);
  const Grid grid = fit_grid(mesh, expected.levels);
  const Svdag dag = build_svdag(mesh, grid).dag;
  const SvdagCounts counts = count_svdag(dag.view());
  EXPECT_EQ(counts.voxels, expected.voxels);
  EXPECT_EQ(counts.svo_nodes(), expected.svo_nodes);
  EXPECT_EQ(counts.dag_nodes(), expected.dag_nodes);
  EXPECT_EQ(dag.view().bytes(), expected.dag_bytes);
  EXPECT_EQ(check_cover(dag.view(), grid, mesh, 20000).mismatches, 0u);
  if (expected.levels == 11) {
    EXPECT_EQ(build_svdag(mesh, grid, BuildMethod::kSort).dag, dag);
    EXPECT_EQ(build_svdag(mesh, grid, BuildMethod::kPaper).dag, dag);
  }
}

INSTANTIATE_TEST_SUITE_P(Levels, CrytekSponza, testing::ValuesIn(kSponza), [](const auto& tested) {
  return std::to_string(1 << tested.param.levels);
});

}  // namespace
}  // namespace voxdag
