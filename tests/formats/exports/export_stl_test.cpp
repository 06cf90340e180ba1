// STL files: closed meshes of outer faces, normals, and places far from the origin.
#include <gtest/gtest.h>

#include <map>

#include "colored_scene.hpp"
#include "face_areas.hpp"
#include "read_back.hpp"
#include "support/error_of.hpp"
#include "support/temp_dir.hpp"
#include "voxdag/formats/exports/faces/export_faces.hpp"
#include "voxdag/formats/readers/mesh_chunks.hpp"
#include "voxdag/formats/readers/read_mesh.hpp"

namespace voxdag {
namespace {

TEST(ExportStl, TheMeshIsClosed) {
  const TempDir dir;
  const ExportedScene scene(5, 3000);
  export_stl(dir / "v.stl", scene.view(), scene.grid);
  const std::string bytes = read_text(dir / "v.stl");
  const auto count = read_at<std::uint32_t>(bytes, 80);
  ASSERT_EQ(bytes.size(), 84 + std::size_t{50} * count);
  EXPECT_FALSE(bytes.starts_with("solid"));
  std::vector<ReadPolygon> triangles;
  using Corner = std::array<float, 3>;
  std::map<std::pair<Corner, Corner>, int> edges;
  for (std::size_t i = 0; i < count; ++i) {
    ReadPolygon triangle;
    std::array<Corner, 3> corners;
    for (std::size_t c = 0; c < 3; ++c) {
      const auto p = read_at<Vec3f>(bytes, 84 + 50 * i + 12 * (c + 1));
      corners[c] = {p.x, p.y, p.z};
      triangle.corners.push_back((Vec3d(p) - scene.grid.origin) * 4.0);
    }
    for (std::size_t c = 0; c < 3; ++c) {
      ++edges[{corners[c], corners[(c + 1) % 3]}];
      --edges[{corners[(c + 1) % 3], corners[c]}];
    }
    const Vec3d normal =
        cross(triangle.corners[1] - triangle.corners[0], triangle.corners[2] - triangle.corners[0]);
    EXPECT_EQ(Vec3f(normal), read_at<Vec3f>(bytes, 84 + 50 * i));
    triangles.push_back(triangle);
  }
  for (const auto& [edge, balance] : edges) EXPECT_EQ(balance, 0);
  EXPECT_EQ(areas_of(triangles), areas_of(scene.view(), whole_grid(5)));
}

TEST(ExportStl, SmoothTrianglesHaveNormalsOfTheirOwn) {
  const TempDir dir;
  const ExportedScene scene(5, 3000);
  ExportOptions options;
  options.faces = FaceMesh::kSmooth;
  export_stl(dir / "v.stl", scene.view(), scene.grid, options);
  const std::string bytes = read_text(dir / "v.stl");
  std::map<std::pair<std::array<float, 3>, std::array<float, 3>>, int> edges;
  for (std::size_t at = 84; at < bytes.size(); at += 50) {
    const auto corners = read_at<std::array<Vec3f, 3>>(bytes, at + 12);
    const Vec3d normal =
        cross(Vec3d(corners[1]) - Vec3d(corners[0]), Vec3d(corners[2]) - Vec3d(corners[0]));
    // Coordinates are rounded to 2^-19 of a voxel.
    EXPECT_LT(length(normalized(normal) - Vec3d(read_at<Vec3f>(bytes, at))), 1e-4);
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3f a = corners[c], b = corners[(c + 1) % 3];
      ++edges[{{a.x, a.y, a.z}, {b.x, b.y, b.z}}];
      --edges[{{b.x, b.y, b.z}, {a.x, a.y, a.z}}];
    }
  }
  for (const auto& [edge, balance] : edges) EXPECT_EQ(balance, 0);
}

/// Returns the triangles of an STL file, as written.
std::vector<std::array<Vec3f, 3>> stl_triangles(const std::string& bytes) {
  std::vector<std::array<Vec3f, 3>> triangles(read_at<std::uint32_t>(bytes, 80));
  for (std::size_t i = 0; i < triangles.size(); ++i)
    triangles[i] = read_at<std::array<Vec3f, 3>>(bytes, 84 + 50 * i + 12);
  return triangles;
}

TEST(ExportStl, AFarGridHasALocalOriginAndTheOffsetIsSaid) {
  const TempDir dir;
  ExportedScene scene(6, 100);
  std::vector<std::string> notes;
  ExportOptions options;
  options.notes = &notes;
  options.window = kWindow;
  scene.grid.origin = {0, 0, 0};
  export_stl(dir / "near.stl", scene.view(), scene.grid, options);
  EXPECT_TRUE(notes.empty());
  EXPECT_EQ(dir.count(), 1);
  scene.grid.origin.x = 1e6;
  export_stl(dir / "far.stl", scene.view(), scene.grid, options);
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_NE(notes[0].find("offset 1000000.75 0.25 1.5"), std::string::npos) << notes[0];
  EXPECT_EQ(placement_of(dir / "far.stl")["offset"], nlohmann::json({1000000.75, 0.25, 1.5}));
  const auto near = stl_triangles(read_text(dir / "near.stl"));
  const auto far = stl_triangles(read_text(dir / "far.stl"));
  ASSERT_EQ(near.size(), far.size());
  for (std::size_t i = 0; i < near.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_EQ(far[i][c] + (Vec3f{0.75f, 0.25f, 1.5f}), near[i][c]);
  // The reader adds the offset.
  EXPECT_EQ(read_mesh(dir / "near.stl").origin, (Vec3d{}));
  EXPECT_EQ(read_mesh(dir / "far.stl").origin, (Vec3d{1000000.75, 0.25, 1.5}));
  EXPECT_EQ(open_mesh_chunks(dir / "far.stl", {}, 1 << 20), nullptr);
  EXPECT_NE(open_mesh_chunks(dir / "near.stl", {}, 1 << 20), nullptr);
  // Another export of this name needs no offset.
  std::filesystem::rename(dir / "far.stl.json", dir / "near.stl.json");
  scene.grid.origin.x = 0;
  export_stl(dir / "near.stl", scene.view(), scene.grid, options);
  EXPECT_FALSE(std::filesystem::exists(dir / "near.stl.json"));
  // Voxels that are too small for floats are refused.
  scene.grid.voxel_size = 1e-300;
  EXPECT_NE(error_of([&] {
              export_stl(dir / "small.stl", scene.view(), scene.grid);
            }).find("cannot hold voxels of this size"),
            std::string::npos);
}

}  // namespace
}  // namespace voxdag
