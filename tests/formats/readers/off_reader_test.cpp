#include "voxdag/formats/readers/off/off_reader.hpp"

#include "formats/readers/mesh_text.hpp"

namespace voxdag {
namespace {

const std::string kOffSquare =
    "OFF # by hand\n4 1 0\n0 0 0\n1 0 0\n\n1 1 0.5 # a corner\n0 1 0\n4 0 1 2 3 255 0 0\n";

TEST(OffReader, PolygonBecomesAFan) {
  const Mesh mesh = read_text(read_off, kOffSquare);
  EXPECT_EQ(mesh.vertices, (StoredVector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5f}, {0, 1, 0}}));
  EXPECT_EQ(mesh.triangles, (StoredVector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(OffReader, VariantsWithMorePerVertexAreRead) {
  EXPECT_EQ(
      read_text(read_off, "COFF 3 1 0\n0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n0 1 0 0 0 0 0\n3 0 1 2\n")
          .triangles.size(),
      1u);
}

TEST(OffReader, RefusalsNameTheLine) {
  const auto refused = [](std::string_view from, std::string_view to) {
    std::string text = kOffSquare;
    return refusal(read_off, text.replace(text.find(from), from.size(), to));
  };
  EXPECT_EQ(refusal(read_off, "off\n"),
            "mesh: line 1: not an OFF file: it does not start with 'OFF'");
  EXPECT_EQ(refused("OFF", "4OFF"),
            "mesh: line 1: 4OFF and nOFF are not supported: vertices must have three coordinates");
  EXPECT_EQ(refused("OFF #", "OFF BINARY #"),
            "mesh: line 1: binary OFF is not supported: save it as text");
  EXPECT_EQ(refused("4 1 0", "353535235358 6 0"),
            "mesh: line 2: the file is too short for 353535235358 vertices");
  EXPECT_EQ(refused("4 1 0", "4 3 0"), "mesh: line 9: the file ends before its last face");
  EXPECT_EQ(refused("4 0 1 2 3", "4 0 1 2 4"),
            "mesh: line 8: vertex index 4 is out of range: 4 vertices");
  EXPECT_EQ(
      refused("4 0 1 2 3 255 0 0", "9 0 1 2"),
      "mesh: line 8: the number of vertex indices is missing, or the row is too short for it");
  EXPECT_EQ(refused("0.5", "inf"), "mesh: line 8: vertex 2 is not finite and this face uses it");
}

TEST(OffReader, AnyPrefixIsSafe) { expect_any_prefix_is_safe(read_off, kOffSquare); }

}  // namespace
}  // namespace voxdag
