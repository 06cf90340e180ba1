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
  EXPECT_EQ(refusal(read_off, "of\n"),
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
  EXPECT_EQ(refused("1 0 0\n", "1 0\n"), "mesh: line 4: coordinate '' is not a number");
}

TEST(OffReader, CountsMayBeInTheFirstWordAndWithoutEdges) {
  const Mesh square = read_text(read_off, kOffSquare);
  for (const std::string counts :
       {"OFF4 1 0\n", "OFF4 1\n", "OFF\n4 1\n", "OFF 4 1\n", "off\n4 1 0\n"})
    EXPECT_TRUE(read_text(read_off, counts + kOffSquare.substr(kOffSquare.find("0 0 0"))) == square)
        << counts;
  EXPECT_TRUE(is_off("OFF8 12 0\n"));
  EXPECT_FALSE(is_off("OFFER 1\n"));
}

TEST(OffReader, RowsMayBeDividedOverLinesOtherwise) {
  const Mesh square = read_text(read_off, kOffSquare);
  for (const std::string text : {"OFF\n4\n1\n0\n0 0 0 1 0 0 1\n1 0.5 0\n1 0 4 0\n1 2 3\n",
                                 "OFF 4 1 0 0 0 1 0 0 1 1 0.5 0 1 0 4 0 1 2 3",
                                 "OFF 4 1 0 0 0 0 1 0 0 1 1 0.5 0 1 0 4 0 1 2 3 # the end\n\n"}) {
    const auto read = read_off({text, "mesh", {}, nullptr, {}}, ReadParts::kMesh);
    EXPECT_TRUE(read.mesh == square) << text;
    EXPECT_EQ(read.warnings,
              std::vector<std::string>{
                  "mesh: rows are not one per line: the numbers are read as one list"});
  }
  const Mesh colored = read_text(
      read_off,
      "NCOFF 3 1 0\n0 0 0 0 0 1 1 1 1 1 1 0 0 0 0 1 1 1 1 1\n0 1 0 0 0 1 0 0 0 0\n3 0 1 2\n");
  EXPECT_EQ(colored.vertices, (StoredVector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}));
}

TEST(OffReader, TheFirstWordMayBeMissing) {
  const auto read = read_off({"3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "mesh", {}, nullptr, {}},
                             ReadParts::kMesh);
  EXPECT_EQ(read.mesh.triangles, (StoredVector<Triangle>{{0, 1, 2}}));
  EXPECT_EQ(read.warnings, std::vector<std::string>{"mesh: the first word, 'OFF', is missing"});
  EXPECT_NE(refusal(read_off, "3 1.5 0\n").find("does not start with 'OFF'"), std::string::npos);
}

TEST(OffReader, AListMustEndWithTheLastFace) {
  EXPECT_EQ(refusal(read_off, "OFF 3 1 0 0 0 0 1 0 0 0 1 0 3 0 1 2 7"),
            "mesh: line 1: the file ends before its last face");
}

TEST(OffReader, VerticesAndFacesMayHaveColours) {
  const auto colors_of = [](const std::string& text) {
    const auto read = read_off({text, "mesh", {}, nullptr, {}}, ReadParts::kMeshAndAppearance);
    EXPECT_TRUE(read.warnings.empty());
    return read.appearance.colors;
  };
  const Rgba16 red{65535, 0, 0, 65535}, blue{0, 0, 65535, 65535};
  const std::string faces = "3 0 1 2\n";
  const std::vector<Rgba16> in_red(3, red), in_blue(3, blue);
  EXPECT_EQ(
      colors_of("COFF 3 1 0\n0 0 0 255 0 0 255\n1 0 0 255 0 0 255\n0 1 0 255 0 0 255\n" + faces),
      in_red);
  EXPECT_EQ(colors_of("COFF 3 1 0\n0 0 0 1 0 0 1\n1 0 0 1 0 0 1\n0 1 0 1 0 0 1\n" + faces), in_red);
  EXPECT_EQ(
      colors_of("NCOFF 3 1 0\n0 0 0 9 9 9 1 0 0\n1 0 0 9 9 9 1 0 0\n0 1 0 9 9 9 1 0 0\n" + faces),
      in_red);
  const std::string points = "0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_EQ(colors_of("OFF 3 1 0\n" + points + "3 0 1 2 0 0 255\n"), in_blue);
  EXPECT_EQ(colors_of("OFF 3 1 0\n" + points + "3 0 1 2 0.0 0.0 1.0 0.5\n"), in_blue);
  EXPECT_TRUE(colors_of("OFF 3 1 0\n" + points + "3 0 1 2 7\n").empty());  // an index into a map
  EXPECT_EQ(colors_of("OFF 3 2 0\n" + points + "3 0 1 2\n3 0 1 2 0 0 255\n"),
            (std::vector<Rgba16>{to_rgba16(kDefaultColor, 1), to_rgba16(kDefaultColor, 1),
                                 to_rgba16(kDefaultColor, 1), blue, blue, blue}));
}

TEST(OffReader, AnyPrefixIsSafe) {
  expect_any_prefix_is_safe(read_off, kOffSquare);
  expect_any_prefix_is_safe(read_off, "OFF 4 1 0 0 0 0 1 0 0 1 1 0.5 0 1 0 4 0 1 2 3");
}

}  // namespace
}  // namespace voxdag
