#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

#include "voxdag/formats/readers/read_mesh.hpp"
#include "voxdag/formats/scenes/ply_writer.hpp"
#include "voxdag/formats/scenes/scenes.hpp"

namespace voxdag {
namespace {

TEST(PlyWriter, AMeshWithMaterialsSurvivesTheRoundTrip) {
  const auto path = std::filesystem::temp_directory_path() /
                    ("voxdag_round_trip_" + std::to_string(::getpid()) + ".ply");
  const Mesh mesh = make_scene("city", {1, 1});
  write_ply(path, mesh);
  const Mesh back = read_mesh(path);
  std::filesystem::remove(path);
  EXPECT_EQ(back.vertices, mesh.vertices);
  EXPECT_EQ(back.triangles, mesh.triangles);
  EXPECT_EQ(back.triangle_materials, mesh.triangle_materials);
  EXPECT_EQ(back.materials, mesh.materials);
}

}  // namespace
}  // namespace voxdag
