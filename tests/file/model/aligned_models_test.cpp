#include "voxdag/file/model/aligned_models.hpp"

#include <gtest/gtest.h>

#include "support/brute_svdag.hpp"
#include "support/error_of.hpp"
#include "voxdag/file/model/edited.hpp"

namespace voxdag {
namespace {

DagModel model_of(int levels, const std::vector<Vec3i>& voxels, Vec3d origin) {
  VdagMetadata metadata;
  metadata.grid.levels = levels;
  metadata.grid.origin = origin;
  metadata.source.name = "m";
  return {brute_svdag(levels, voxels), {}, metadata};
}

TEST(AlignedModels, ResultsLieInTheGridThatHoldsThem) {
  // Voxel (1, 2, 3) of the second is voxel (5, 2, 3) of the first.
  const DagModel first = model_of(3, {{5, 2, 3}, {0, 0, 0}}, {0, 0, 0});
  const DagModel second = model_of(3, {{1, 2, 3}, {7, 7, 7}}, {4, 0, 0});
  const AlignedModels models(first, second, {});
  EXPECT_EQ(models.grid().levels, 4);
  EXPECT_EQ(models.grid_of(SetOperation::kIntersection), first.grid());
  EXPECT_EQ(models.grid_of(SetOperation::kUnion), models.grid());
  EXPECT_EQ(models.result(SetOperation::kIntersection), brute_svdag(3, {{5, 2, 3}}));
  EXPECT_EQ(models.result(SetOperation::kDifference), brute_svdag(3, {{0, 0, 0}}));
  EXPECT_EQ(models.result(SetOperation::kUnion),
            brute_svdag(4, {{5, 2, 3}, {0, 0, 0}, {11, 7, 7}}));
  EXPECT_EQ(models.combine(SetOperation::kSymmetric), brute_svdag(4, {{0, 0, 0}, {11, 7, 7}}));
}

TEST(AlignedModels, GridsThatDoNotAlignAreRefused) {
  const DagModel first = model_of(3, {{0, 0, 0}}, {0, 0, 0});
  const DagModel second = model_of(3, {{0, 0, 0}}, {0.5, 0, 0});
  EXPECT_NE(error_of([&] {
              AlignedModels(first, second, {});
            }).find("the grids do not align"),
            std::string::npos);
}

TEST(Edited, KeepsTheMetadataAndAddsTheEdit) {
  const DagModel source = model_of(3, {{0, 0, 0}}, {1, 2, 3});
  const DagModel once = edited(source, brute_svdag(3, {{1, 1, 1}, {2, 2, 2}}), source.grid(), "a");
  const DagModel twice = edited(once, brute_svdag(3, {{1, 1, 1}}), source.grid(), "b");
  EXPECT_EQ(twice.metadata().build.at("edits"), "a; b");
  EXPECT_EQ(twice.metadata().source, source.metadata().source);
  EXPECT_EQ(twice.metadata().counts.voxels, 1u);
}

}  // namespace
}  // namespace voxdag
