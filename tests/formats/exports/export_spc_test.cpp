#include "voxdag/formats/exports/grids/export_spc.hpp"

#include <gtest/gtest.h>

#include "exported_scene.hpp"
#include "support/error_of.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/file/npy.hpp"

namespace voxdag {
namespace {

/// Returns the points of an SPC octree, as kaolin generates them: breadth first, each node's
/// children in the order of their bits.
std::set<VoxelKey> spc_points(const std::string& npy, int levels) {
  std::size_t at = npy.find('\n') + 1;
  std::vector<Vec3i> cells{{0, 0, 0}};
  for (int level = 0; level < levels; ++level) {
    std::vector<Vec3i> children;
    for (const Vec3i cell : cells) {
      const auto mask = static_cast<unsigned char>(npy.at(at++));
      for (int child = 0; child < 8; ++child)
        if ((mask >> child & 1) != 0)
          children.push_back(
              {2 * cell.x + (child >> 2), 2 * cell.y + (child >> 1 & 1), 2 * cell.z + (child & 1)});
    }
    cells = children;
  }
  EXPECT_EQ(at, npy.size());
  std::set<VoxelKey> points;
  for (const Vec3i cell : cells) points.insert({cell.x, cell.y, cell.z});
  return points;
}

TEST(ExportSpc, KaolinFindsTheVoxels) {
  const TempDir dir;
  for (const int levels : {2, 3, 6}) {
    const ExportedScene scene(levels, 20 << levels);
    export_spc(dir / "v.spc.npy", scene.view(), scene.grid);
    EXPECT_EQ(spc_points(read_text(dir / "v.spc.npy"), levels), scene.set);
    EXPECT_EQ(placement_of(dir / "v.spc.npy")["grid"]["resolution"], 1 << levels);
  }
  const ExportedScene empty(4, 0), large(16, 5);
  export_spc(dir / "e.spc.npy", empty.view(), empty.grid);
  EXPECT_EQ(NpyReader(dir / "e.spc.npy", "|u1", {}, 1).rows(), 0u);
  EXPECT_EQ(error_of([&] { export_spc(dir / "l.spc.npy", large.view(), large.grid); }),
            (dir / "l.spc.npy").string() +
                ": 65536 voxels a side are more than the 32768 of kaolin: choose a smaller "
                "--window, or make a coarser grid (voxdag coarsen)");
}

}  // namespace
}  // namespace voxdag
