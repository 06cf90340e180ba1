#include "voxdag/formats/readers/ply/ply_reader.hpp"

#include "formats/readers/mesh_text.hpp"

namespace voxdag {
namespace {

const std::string kPlySquare =
    "ply\nformat ascii 1.0\ncomment made by hand\nobj_info none\nelement vertex 4\n"
    "property float x\nproperty float y\nproperty float z\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n";

std::string replaced(std::string text, std::string_view from, std::string_view to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos);
  return text.replace(at, from.size(), to);
}

/// Returns a square with extra properties, lists and elements that the reader must skip.
std::string binary_square(bool big_endian, bool with_lists = true) {
  std::string text = "ply\nformat ";
  text += big_endian ? "binary_big_endian 1.0\n" : "binary_little_endian 1.0\n";
  text += "comment material 0 Stone wall\ncomment material 1 Wood\n";
  text += "element extra 2\nproperty list ushort double values\nproperty uchar tag\n";
  text += "element vertex 4\nproperty short id\n";
  if (with_lists) text += "property list uint8 int16 neighbours\n";
  text += "property float x\nproperty double y\nproperty int z\nproperty uchar red\n";
  text += "element face 2\nproperty ushort material_index\nproperty list uchar uint vertex_index\n";
  text += "property list int float uv\nend_header\n";
  for (int row = 0; row < 2; ++row) {
    append<std::uint16_t>(text, 1, big_endian);
    append(text, 2.5, big_endian);
    append<std::uint8_t>(text, 10);  // looks like a line end
  }
  for (int i = 0; i < 4; ++i) {
    append<std::int16_t>(text, static_cast<std::int16_t>(i), big_endian);
    if (with_lists) {
      append<std::uint8_t>(text, static_cast<std::uint8_t>(i));
      for (int n = 0; n < i; ++n) append<std::int16_t>(text, -1, big_endian);
    }
    append<float>(text, i == 1 || i == 2 ? 1.5f : 0, big_endian);
    append<double>(text, i >= 2 ? 0.1 : 0, big_endian);
    append<std::int32_t>(text, -7, big_endian);
    append<std::uint8_t>(text, 255);
  }
  for (const std::vector<std::uint32_t>& face :
       {std::vector<std::uint32_t>{0, 1, 2, 3}, std::vector<std::uint32_t>{3, 2, 1}}) {
    append<std::uint16_t>(text, face.size() == 3, big_endian);
    append(text, static_cast<std::uint8_t>(face.size()));
    for (const std::uint32_t index : face) append(text, index, big_endian);
    append<std::int32_t>(text, 1, big_endian);
    append(text, 0.5f, big_endian);
  }
  return text;
}

TEST(PlyReader, AsciiPolygonBecomesAFan) {
  const Mesh mesh = read_text(read_ply, kPlySquare);
  EXPECT_EQ(mesh.vertices, (StoredVector<Vec3f>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(mesh.triangles, (StoredVector<Triangle>{{0, 1, 2}, {0, 2, 3}}));
}

TEST(PlyReader, BinaryInBothOrdersSkipsWhatItDoesNotKnow) {
  for (const bool big_endian : {false, true})
    for (const bool with_lists : {false, true}) {
      const Mesh mesh = read_text(read_ply, binary_square(big_endian, with_lists));
      EXPECT_EQ(mesh.vertices,
                (StoredVector<Vec3f>{{0, 0, -7}, {1.5f, 0, -7}, {1.5f, 0.1f, -7}, {0, 0.1f, -7}}));
      EXPECT_EQ(mesh.triangles, (StoredVector<Triangle>{{0, 1, 2}, {0, 2, 3}, {3, 2, 1}}));
      EXPECT_EQ(mesh.materials, (std::vector<std::string>{"Stone wall", "Wood"}));
      EXPECT_EQ(mesh.triangle_materials, (StoredVector<std::uint32_t>{0, 0, 1}));
    }
}

TEST(PlyReader, EveryLineEndIsUnderstood) {
  const Mesh expected = read_text(read_ply, kPlySquare);
  for (const std::string end : {"\r\n", "\r"}) {
    std::string text;
    for (const char c : kPlySquare) c == '\n' ? text += end : text += c;
    EXPECT_TRUE(read_text(read_ply, text) == expected);
  }
}

TEST(PlyReader, BinaryBodyMayStartWithALineEnd) {
  for (const std::string end : {"\n", "\r\n"}) {
    std::string text;
    for (const char c : std::string("ply\nformat binary_little_endian 1.0\nelement tag 1\n"
                                    "property uchar a\nelement vertex 3\nproperty float x\n"
                                    "property float y\nproperty float z\nelement face 1\n"
                                    "property list uchar int vertex_indices\nend_header\n"))
      c == '\n' ? text += end : text += c;
    append<std::uint8_t>(text, '\n');
    for (int i = 0; i < 9; ++i) append(text, static_cast<float>(i));
    append<std::uint8_t>(text, 3);
    for (int i = 0; i < 3; ++i) append(text, i);
    EXPECT_EQ(read_text(read_ply, text).vertices[2], (Vec3f{6, 7, 8})) << end.size();
  }
}

TEST(PlyReader, EveryScalarTypeHasItsTwoNames) {
  for (const std::string type : {"char", "int8", "uchar", "uint8", "short", "int16", "ushort",
                                 "uint16", "int", "int32", "uint", "uint32"}) {
    std::string text = replaced(kPlySquare, "list uchar int", "list " + type + " " + type);
    EXPECT_EQ(read_text(read_ply, text).triangles.size(), 2u) << type;
  }
  for (const std::string type : {"float", "float32", "double", "float64"})
    EXPECT_EQ(read_text(read_ply, replaced(kPlySquare, "float x", type + " x")).vertices[1].x,
              1.0f);
}

TEST(PlyReader, HeaderFaultsNameTheLine) {
  const auto refused = [](std::string_view from, std::string_view to) {
    return refusal(read_ply, replaced(kPlySquare, from, to));
  };
  EXPECT_EQ(refusal(read_ply, ""), "mesh: the file is empty");
  EXPECT_EQ(refusal(read_ply, "plum\n"),
            "mesh: line 1: not a PLY file: it does not start with 'ply'");
  EXPECT_EQ(refused("ascii 1.0", "ascii 2.0"), "mesh: line 2: unknown PLY version '2.0'");
  EXPECT_EQ(refused("ascii", "utf8"), "mesh: line 2: unknown PLY format 'utf8'");
  EXPECT_EQ(refused("vertex 4", "vertex four"),
            "mesh: line 5: count 'four' of element 'vertex' is not a number");
  EXPECT_EQ(refused("vertex 4", "vertex 4000000000000"),
            "mesh: line 11: the file is too short for 4000000000000 rows of element 'vertex'");
  EXPECT_EQ(refused("face 1", "face 18446744073709551615"),
            "mesh: line 9: count '18446744073709551615' of element 'face' is not a number");
  EXPECT_EQ(refused("float y", "half y"), "mesh: line 7: unknown PLY type 'half'");
  EXPECT_EQ(refused("list uchar", "list float"),
            "mesh: line 10: a list count must have an integer type, not 'float'");
  EXPECT_EQ(refused("float y", "float x"), "mesh: line 7: property 'x' is declared twice");
  EXPECT_EQ(refused("element face", "element vertex"),
            "mesh: line 9: element 'vertex' is declared twice");
  EXPECT_EQ(refused("element face", "element edge"),
            "mesh: line 11: PLY without a 'face' element: there is no surface to read");
  EXPECT_EQ(refused("vertex_indices", "corners"),
            "mesh: line 11: PLY faces without property 'vertex_indices'");
  EXPECT_EQ(refused("end_header\n", "oops\n"), "mesh: line 11: unknown PLY header keyword 'oops'");
}

TEST(PlyReader, BodyFaultsNameTheLine) {
  const auto refused = [](std::string_view from, std::string_view to) {
    return refusal(read_ply, replaced(kPlySquare, from, to));
  };
  EXPECT_EQ(refused("4 0 1 2 3", "4 0 1 2 4"),
            "mesh: line 16: vertex index 4 is out of range: 4 vertices");
  EXPECT_EQ(refused("4 0 1 2 3", "4 0 1 2 -1"),
            "mesh: line 16: vertex index -1 is out of range: 4 vertices");
  EXPECT_EQ(refused("4 0 1 2 3", "4 0 1 2"),
            "mesh: line 16: the row ends before property 'vertex_indices'");
  EXPECT_EQ(refused("4 0 1 2 3", "3 0 1 2 3"),
            "mesh: line 16: the row has '3' after its last property");
  EXPECT_EQ(refused("4 0 1 2 3", "2 0 1"),
            "mesh: no face has three corners or more: there is no surface to read");
  EXPECT_EQ(refused("1 1 0\n", "1 one 0\n"), "mesh: line 14: coordinate 'one' is not a number");
  EXPECT_EQ(refused("4 0 1 2 3\n", ""),
            "mesh: line 16: the file ends after 0 of 1 rows of element 'face'");
}

TEST(PlyReader, BinaryFaultsNameTheByte) {
  const std::string square = binary_square(false, false);
  const std::size_t body = square.find("end_header\n") + 11;
  std::string bad = square;
  const std::size_t first_index = body + 2 * 11 + 4 * 19 + 3;
  bad[first_index] = 4;
  EXPECT_EQ(refusal(read_ply, bad), "mesh: byte " + std::to_string(first_index) +
                                        ": vertex index 4 is out of range: 4 vertices");
  EXPECT_EQ(refusal(read_ply, square.substr(0, body + 80)),
            "mesh: byte " + std::to_string(body + 80) +
                ": the file ends after 3 of 4 rows of element 'vertex'");
}

std::string strips(bool is_text) {
  std::string text =
      std::string("ply\nformat ") + (is_text ? "ascii" : "binary_little_endian") +
      " 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
      "element tristrips 2\nproperty list int int vertex_indices\nend_header\n";
  const std::vector<std::vector<std::int32_t>> rows = {{0, 1, 2, 3, -1, 2, 3, 4, -1, 0, 1},
                                                       {0, 1, 2, 2, 3, 4}};
  const auto add = [&](auto number, char after) {
    if (is_text)
      text += std::to_string(number) + after;
    else
      append(text, number);
  };
  for (int v = 0; v < 5; ++v) {
    add(static_cast<float>(v), ' ');
    add(static_cast<float>(v * v), ' ');
    add(0.0f, '\n');
  }
  for (const auto& row : rows) {
    add(static_cast<std::int32_t>(row.size()), ' ');
    for (std::size_t i = 0; i < row.size(); ++i) add(row[i], i + 1 < row.size() ? ' ' : '\n');
  }
  return text;
}

TEST(PlyReader, TriangleStripsAlternateTheirWinding) {
  for (const bool is_text : {true, false}) {
    const std::string text = strips(is_text);
    // Triangles with two equal corners only join strips.
    EXPECT_EQ(read_text(read_ply, text).triangles,
              (StoredVector<Triangle>{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}, {0, 1, 2}, {3, 2, 4}}));
    EXPECT_NE(refusal(read_ply, replaced(text, "element vertex 5", "element vertex 4")), "");
    expect_any_prefix_is_safe(read_ply, text);
  }
}

TEST(PlyReader, FacesBesideStripsAreRefused) {
  EXPECT_NE(refusal(read_ply, replaced(kPlySquare, "end_header\n",
                                       "element tristrips 1\nproperty list int int vertex_indices\n"
                                       "end_header\n"))
                .find("PLY with faces and triangle strips"),
            std::string::npos);
}

TEST(PlyReader, AnyPrefixIsSafe) {
  expect_any_prefix_is_safe(read_ply, kPlySquare);
  expect_any_prefix_is_safe(read_ply, binary_square(false));
  expect_any_prefix_is_safe(read_ply, binary_square(true, false));
}

}  // namespace
}  // namespace voxdag
