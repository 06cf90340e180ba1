// Exports voxels with the attributes of a DAG's cells.
#include <gtest/gtest.h>

#include "colored_scene.hpp"
#include "exported_ply.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/file/npy.hpp"

namespace voxdag {
namespace {

TEST(ExportPly, PointsHaveTheAttributesOfTheirCells) {
  for (const int finest : {6, 5, 3, 0}) {
    const TempDir dir;
    const ColoredScene scene(finest);
    export_ply_points(dir / "v.ply", scene.view(), scene.grid, scene.options);
    const ExportedPly ply(read_text(dir / "v.ply"));
    ASSERT_EQ(ply.vertices.size(), scene.set.size());
    for (std::size_t i = 0; i < ply.vertices.size(); ++i) {
      const Vec3i voxel((ply.vertices[i] - scene.grid.origin) * 4.0);
      ASSERT_EQ(ply.colors.at(i), scene.value(voxel));
      ASSERT_EQ(ply.normals.at(i), unpack_normal(scene.value(voxel)));
      ASSERT_EQ(ply.materials.at(i), material_of_number(scene.number(voxel)));
    }
  }
}

TEST(ExportPly, FacesHaveTheAttributesOfTheirVoxel) {
  const TempDir dir;
  const ColoredScene scene(6);
  export_ply_faces(dir / "grey.ply", scene.view(), scene.grid);
  export_ply_faces(dir / "v.ply", scene.view(), scene.grid, scene.options);
  const ExportedPly ply(read_text(dir / "v.ply"));
  EXPECT_EQ(faces_of(ply, scene.grid),
            faces_of(ExportedPly(read_text(dir / "grey.ply")), scene.grid));
  for (const auto& face : ply.faces) {
    std::array<Vec3d, 4> p;
    for (int i = 0; i < 4; ++i) p[i] = (ply.vertices.at(face[i]) - scene.grid.origin) * 4.0;
    const Vec3d inside = (p[0] + p[2]) * 0.5 - cross(p[1] - p[0], p[2] - p[1]) * 0.5;
    for (const std::uint32_t corner : face) {
      ASSERT_EQ(ply.colors.at(corner), scene.value(Vec3i(inside)));
      ASSERT_EQ(ply.normals.at(corner), unpack_normal(scene.value(Vec3i(inside))));
      ASSERT_EQ(ply.materials.at(corner), material_of_number(scene.number(Vec3i(inside))));
    }
  }
}

TEST(ExportNpy, CoordinatesComeWithAttributes) {
  const TempDir dir;
  const ColoredScene scene(6);
  export_npy_coordinates(dir / "v.npy", scene.view(), scene.grid, scene.options);
  const std::string dtype =
      "[('voxel', '<i4', (3,)), ('normal', '<f4', (3,)), ('color', '|u1', (3,)), "
      "('material', '<u2')]";
  constexpr std::size_t kBytes = 29;
  NpyReader reader(dir / "v.npy", dtype, {}, kBytes);
  ASSERT_EQ(reader.rows(), scene.set.size());
  std::string row(kBytes, '\0');
  while (reader.read_rows(row.data(), 1) == 1) {
    const Vec3i voxel = peek<Vec3i>(row, 0);
    ASSERT_TRUE(scene.has(voxel.x, voxel.y, voxel.z));
    ASSERT_EQ(peek<Vec3f>(row, 12), unpack_normal(scene.value(voxel)));
    ASSERT_EQ(peek<Value8>(row, 24), scene.value(voxel));
    ASSERT_EQ(peek<std::uint16_t>(row, 27), material_of_number(scene.number(voxel)));
  }
  EXPECT_EQ(placement_of(dir / "v.npy")["array"]["dtype"], dtype);
}

}  // namespace
}  // namespace voxdag
