// Dense volumes: those that import reads come back, the others are compared byte by byte.
#include <gtest/gtest.h>

#include <algorithm>

#include "read_back.hpp"
#include "support/error_of.hpp"
#include "support/temp_dir.hpp"

namespace voxdag {
namespace {

/// Returns the values of a window of a scene, x fastest.
std::string values_of(const ExportedScene& scene, const Box3i& box) {
  std::string values;
  for (int z = box.lo.z; z < box.hi.z; ++z)
    for (int y = box.lo.y; y < box.hi.y; ++y)
      for (int x = box.lo.x; x < box.hi.x; ++x) values += scene.has(x, y, z) ? '\1' : '\0';
  return values;
}

TEST(ExportVolume, ComesBackToItsPlace) {
  const TempDir dir;
  const ExportedScene scene(5);
  for (const char* name : {"v.nrrd", "v.nii", "v.nii.gz"}) {
    export_voxels(dir / name, scene.view(), scene.grid, {}, windowed(kWindow.lo, kWindow.hi));
    EXPECT_EQ(read_back(dir / name, kWindow.lo), voxels_of(scene, kWindow)) << name;
    const Grid grid = open_voxel_source(dir / name)->grid().value();
    EXPECT_EQ(grid.voxel_size, scene.grid.voxel_size) << name;
    EXPECT_EQ(grid.origin, scene.grid.to_world(Vec3d(kWindow.lo))) << name;
    EXPECT_FALSE(std::filesystem::exists(dir / (std::string(name) + ".json"))) << name;
  }
}

TEST(ExportVolume, MetaImageAndVtkHaveTheirHeadersAroundTheValues) {
  const TempDir dir;
  const ExportedScene scene(5);
  const std::string values = values_of(scene, kWindow);
  for (const char* name : {"v.mha", "v.vti"})
    export_voxels(dir / name, scene.view(), scene.grid, {}, windowed(kWindow.lo, kWindow.hi));
  EXPECT_EQ(read_text(dir / "v.mha"),
            "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
            "CompressedData = False\nTransformMatrix = 1 0 0 0 1 0 0 0 1\n"
            "Offset = 10.875 -19.625 2.125\nElementSpacing = 0.25 0.25 0.25\nDimSize = 26 31 7\n"
            "ElementType = MET_UCHAR\nElementDataFile = LOCAL\n" +
                values);
  using namespace std::string_literals;
  EXPECT_EQ(read_text(dir / "v.vti"),
            "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" version=\"1.0\" "
            "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<ImageData WholeExtent=\"0 26 0 "
            "31 0 7\" Origin=\"10.75 -19.75 2\" Spacing=\"0.25 0.25 0.25\">\n<Piece Extent=\"0 26 "
            "0 31 0 7\">\n<CellData Scalars=\"voxels\">\n<DataArray type=\"UInt8\" Name=\"voxels\" "
            "format=\"appended\" offset=\"0\"/>\n</CellData>\n</Piece>\n</ImageData>\n"
            "<AppendedData encoding=\"raw\">\n_\x0a\x16\0\0\0\0\0\0"s +  // 26 * 31 * 7 = 0x160a
                values +
                "\n</AppendedData>\n</VTKFile>\n");
}

TEST(ExportVolume, NiftiRefusesLongerAxesThanItHas) {
  const TempDir dir;
  const Svdag dag = brute_svdag(16, {{40000, 0, 0}});
  Grid grid;
  grid.levels = 16;
  EXPECT_NE(
      error_of([&] {
        export_voxels(dir / "v.nii", dag.view(), grid, {}, windowed({0, 0, 0}, {40000, 1, 1}));
      }).find("at most 32,767 voxels"),
      std::string::npos);
  EXPECT_EQ(dir.count(), 0);
}

}  // namespace
}  // namespace voxdag
