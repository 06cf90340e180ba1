#include "voxdag/formats/exports/grids/export_playcanvas.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cstring>

#include "exported_scene.hpp"
#include "support/error_of.hpp"
#include "support/temp_dir.hpp"
#include "support/voxel_sets.hpp"

namespace voxdag {
namespace {

/// Reads the octree of PlayCanvas as its reader does: it descends by the bits of the block.
class PlayCanvasOctree {
 public:
  explicit PlayCanvasOctree(const std::filesystem::path& json)
      : metadata_(nlohmann::json::parse(read_text(json))) {
    std::string data = json.string();
    data.replace(data.size() - 4, 4, "bin");
    const std::string bytes = read_text(data);
    words_.resize(bytes.size() / 4);
    if (!bytes.empty()) std::memcpy(words_.data(), bytes.data(), bytes.size());
    nodes_ = metadata_["nodeCount"];
    EXPECT_EQ(words_.size(), nodes_ + metadata_["leafDataCount"].get<std::size_t>());
  }
  const nlohmann::json& metadata() const { return metadata_; }
  bool is_solid(Vec3i v) const {
    if (nodes_ == 0) return false;
    std::size_t at = 0;
    for (int level = metadata_["treeDepth"].get<int>() - 1; level >= -1; --level) {
      const std::uint32_t word = words_.at(at);
      if (word == 0xFF000000) return true;
      const std::uint32_t mask = word >> 24;
      if (mask == 0) {
        const std::size_t bit =
            static_cast<std::size_t>((v.x & 3) + 4 * (v.y & 3) + 16 * (v.z & 3));
        return (words_.at(nodes_ + 2 * word + bit / 32) >> (bit % 32) & 1) != 0;
      }
      const Vec3i block{v.x >> 2, v.y >> 2, v.z >> 2};
      const int octant =
          (block.x >> level & 1) | (block.y >> level & 1) << 1 | (block.z >> level & 1) << 2;
      if ((mask >> octant & 1) == 0) return false;
      at = (word & 0xFFFFFF) + static_cast<std::size_t>(std::popcount(mask & ((1u << octant) - 1)));
      EXPECT_LT(at, nodes_);
    }
    return false;
  }

 private:
  nlohmann::json metadata_;
  std::vector<std::uint32_t> words_;
  std::size_t nodes_ = 0;
};

TEST(ExportPlayCanvas, TheReaderFindsTheVoxels) {
  const TempDir dir;
  for (const int levels : {2, 3, 5}) {
    // Full blocks, full cells above them, and single voxels.
    const int n = 1 << levels;
    const std::vector<Vec3i> voxels = voxels_where(levels, [&](Vec3i v) {
      return v.x >= n / 2 || (v.x < n / 4 && v.y < n / 4) || (v.x + 3 * v.y + 5 * v.z) % 7 == 0;
    });
    const Svdag dag = brute_svdag(levels, voxels);
    Grid grid;
    grid.levels = levels;
    grid.origin = {1, 2, 3};
    grid.voxel_size = 0.5;
    export_playcanvas(dir / "v.voxel.json", dag.view(), grid);
    const PlayCanvasOctree octree(dir / "v.voxel.json");
    std::set<VoxelKey> set;
    for (const Vec3i v : voxels) set.insert({v.x, v.y, v.z});
    for (int z = 0; z < n; ++z)
      for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x) EXPECT_EQ(octree.is_solid({x, y, z}), set.contains({x, y, z}));
    EXPECT_EQ(octree.metadata()["gridBounds"]["min"], nlohmann::json({1.0, 2.0, 3.0}));
    EXPECT_EQ(octree.metadata()["gridBounds"]["max"][0], 1 + n * 0.5);
    EXPECT_EQ(octree.metadata()["voxelResolution"], 0.5);
  }
}

TEST(ExportPlayCanvas, EmptyAndFullGrids) {
  const TempDir dir;
  Grid grid;
  grid.levels = 4;
  const Svdag empty = brute_svdag(4, {});
  const Svdag full = brute_svdag(4, voxels_where(4, [](Vec3i) { return true; }));
  export_playcanvas(dir / "e.voxel.json", empty.view(), grid);
  export_playcanvas(dir / "f.voxel.json", full.view(), grid);
  EXPECT_FALSE(PlayCanvasOctree(dir / "e.voxel.json").is_solid({0, 0, 0}));
  EXPECT_TRUE(PlayCanvasOctree(dir / "f.voxel.json").is_solid({7, 8, 9}));
  EXPECT_EQ(PlayCanvasOctree(dir / "f.voxel.json").metadata()["nodeCount"], 1);
}

TEST(ExportPlayCanvas, MoreLeafBlocksThanPointersReachAreRefused) {
  const TempDir dir;
  SvdagView view;
  view.levels = 2;
  view.leaf_block_count = (std::uint64_t{1} << 24) + 1;
  EXPECT_EQ(
      error_of([&] { export_playcanvas(dir / "v.voxel.json", view, {}); }),
      (dir / "v.voxel.json").string() +
          ": 16777217 different leaf blocks are more than the 16777216 of this format: choose "
          "a smaller --window, or make a coarser grid (voxdag coarsen)");
}

}  // namespace
}  // namespace voxdag
