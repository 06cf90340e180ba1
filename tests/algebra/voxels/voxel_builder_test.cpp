#include "voxdag/algebra/voxels/voxel_builder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "support/brute_svdag.hpp"
#include "support/error_of.hpp"
#include "support/temp_dir.hpp"
#include "support/voxel_sets.hpp"

namespace voxdag {
namespace {

TEST(VoxelBuilder, AnyOrderAndMemoryGivesTheDagOfTheSet) {
  const TempDir dir;
  std::mt19937 rng(1);
  for (const int levels : {2, 3, 4, 5, 6})
    for (const NamedVoxels& set : voxel_sets(levels, 4)) {
      const Svdag expected = brute_svdag(levels, set.voxels);
      std::vector<Vec3i> voxels = set.voxels;
      std::shuffle(voxels.begin(), voxels.end(), rng);
      const std::size_t few = std::min<std::size_t>(voxels.size(), 700);
      voxels.insert(voxels.end(), voxels.begin(),
                    voxels.begin() + static_cast<std::ptrdiff_t>(few));
      for (const std::size_t most : {std::size_t{0}, std::size_t{5000}, std::size_t{1} << 20}) {
        VoxelBuilder builder(levels, most, dir.path());
        for (const Vec3i v : voxels) builder.add(v);
        ASSERT_EQ(builder.finish(), expected) << set.name << ", " << levels << " levels";
      }
    }
  EXPECT_EQ(dir.count(), 0);
}

TEST(VoxelBuilder, ManyRunsAreMerged) {
  const TempDir dir;
  std::mt19937 rng(2);
  std::vector<Vec3i> voxels;
  VoxelBuilder builder(10, 0, dir.path());
  for (int i = 0; i < 60'000; ++i) {
    const Vec3i v{static_cast<std::int32_t>(rng() % 1024), static_cast<std::int32_t>(rng() % 64),
                  static_cast<std::int32_t>(rng() % 3)};
    voxels.push_back(v);
    builder.add(v);
    EXPECT_EQ(dir.count(), 0) << "files have no names";
  }
  EXPECT_GT(builder.runs(), 20u);
  EXPECT_EQ(builder.finish(), brute_svdag(10, voxels));
}

TEST(VoxelBuilder, EqualVoxelsTakeNoFiles) {
  const TempDir dir;
  VoxelBuilder builder(20, 0, dir.path());
  for (int i = 0; i < 100'000; ++i) builder.add({i % 3, 1'048'575, 7});
  EXPECT_EQ(builder.runs(), 0u);
  EXPECT_EQ(builder.finish(),
            brute_svdag(20, {{0, 1'048'575, 7}, {1, 1'048'575, 7}, {2, 1'048'575, 7}}));
}

TEST(VoxelBuilder, VoxelsOutsideAreNamed) {
  const TempDir dir;
  VoxelBuilder builder(4, 0, dir.path());
  EXPECT_EQ(reason_of([&] {
              builder.add({3, 16, 0});
            }),
            "voxel (3, 16, 0) lies outside of the grid of 16 voxels a side");
  EXPECT_EQ(reason_of([&] {
              builder.add({-1, 0, 0});
            }),
            "voxel (-1, 0, 0) lies outside of the grid of 16 voxels a side");
  Svdag empty;
  empty.levels = 4;
  EXPECT_EQ(builder.finish(), empty);
}

TEST(VoxelBuilder, AFolderThatTakesNoFileIsAnError) {
  VoxelBuilder builder(12, 0, "/no/such/folder");
  const std::string error = error_of([&] {
    for (int i = 0; i < 5000; ++i) builder.add({i % 4096, i / 4096, 0});
  });
  EXPECT_NE(error.find("/no/such/folder"), std::string::npos) << error;
  EXPECT_NE(error.find("cannot create a file for sorting"), std::string::npos) << error;
}

TEST(VoxelBuilder, MemoryIsCounted) {
  const TempDir dir;
  MemoryBudget memory(64 << 10);
  EXPECT_THROW(
      {
        VoxelBuilder builder(12, 1 << 20, dir.path(), &memory);
        for (int i = 0; i < 100'000; ++i) builder.add({i % 4096, i / 4096, 0});
      },
      OverMemory);
}

}  // namespace
}  // namespace voxdag
