#include "voxdag/formats/readers/stl/stl_reader.hpp"

#include <cmath>

#include "formats/readers/mesh_text.hpp"

namespace voxdag {
namespace {

const std::string kTwoFacets =
    "solid a facet of life\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n"
    "   vertex 1 1 0\n  endloop\n endfacet\n FACET NORMAL nan 0 1\nOUTER LOOP\nVERTEX 0 0 0\n"
    "Vertex 1 1 0\nVERTEX 0 1 1.5e0 ENDLOOP ENDFACET\nendsolid a facet of life\n";

std::string binary_stl(const std::vector<std::array<Vec3f, 3>>& facets, std::string header) {
  header.resize(80);
  append(header, static_cast<std::uint32_t>(facets.size()));
  for (const auto& facet : facets) {
    for (int i = 0; i < 3; ++i) append(header, 0.0f);
    for (const Vec3f& corner : facet)
      for (int axis = 0; axis < 3; ++axis) append(header, corner[axis]);
    append<std::uint16_t>(header, 0);
  }
  return header;
}

const std::vector<std::array<Vec3f, 3>> kFacets = {{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}},
                                                   {{{0, 0, 0}, {1, 1, 0}, {0, 1, 1.5f}}}};
const StoredVector<Vec3f> kWelded = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 1.5f}};
const StoredVector<Triangle> kTriangles = {{0, 1, 2}, {0, 2, 3}};

TEST(StlReader, AsciiCornersAreWelded) {
  const Mesh mesh = read_text(read_stl, kTwoFacets);
  EXPECT_EQ(mesh.vertices, kWelded);
  EXPECT_EQ(mesh.triangles, kTriangles);
}

TEST(StlReader, BinaryIsRecognisedByItsSizeNotByItsFirstWord) {
  for (const std::string header : {"made by hand", "solid, says the header"}) {
    const Mesh mesh = read_text(read_stl, binary_stl(kFacets, header));
    EXPECT_EQ(mesh.vertices, kWelded);
    EXPECT_EQ(mesh.triangles, kTriangles);
  }
}

TEST(StlReader, BytesAfterTheLastFacetAreIgnored) {
  EXPECT_EQ(read_text(read_stl, binary_stl(kFacets, "") + "more").triangles, kTriangles);
}

TEST(StlReader, WeldingComparesBits) {
  const Mesh mesh = read_text(read_stl, binary_stl({{{{0, 0, 0}, {-0.0f, 0, 0}, {0, 0, 0}}}}, ""));
  EXPECT_EQ(mesh.vertices.size(), 2u);
  EXPECT_EQ(mesh.triangles, (StoredVector<Triangle>{{0, 1, 0}}));
}

TEST(StlReader, NumbersEndWhereTheirWordEnds) {
  const auto first_x = [](std::string_view number) {
    std::string text = kTwoFacets;
    return text.replace(text.find("1 0 0"), 1, number);
  };
  for (const char* one : {"+1", "1.", "10e-1", "1.00000000000000000001", "0001"})
    EXPECT_EQ(read_text(read_stl, first_x(one)).vertices[1], (Vec3f{1, 0, 0})) << one;
  for (const std::string word : {"1x", "1.5.2", "1e", "+-1", "0x1", "e1", "-", "1,0"})
    EXPECT_EQ(refusal(read_stl, first_x(word)),
              "mesh: line 5: coordinate '" + word + "' is not a number");
  for (const char* word : {"inf", "nan", "1e39"})
    EXPECT_TRUE(refusal(read_stl, first_x(word)).ends_with("a vertex that is not finite")) << word;
}

TEST(StlReader, SeveralSolidsAreOneMesh) {
  EXPECT_EQ(
      read_text(read_stl, kTwoFacets + "solid empty\nendsolid\n" + kTwoFacets).triangles.size(),
      4u);
}

TEST(StlReader, AGridWeldsToItsPoints) {
  std::vector<std::array<Vec3f, 3>> facets;
  constexpr int kSide = 250;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const auto p = [](int i, int j) {
        return Vec3f{static_cast<float>(i) / 3, static_cast<float>(j) / 7, 0};
      };
      facets.push_back({p(x, y), p(x + 1, y), p(x + 1, y + 1)});
      facets.push_back({p(x, y), p(x + 1, y + 1), p(x, y + 1)});
    }
  const Mesh mesh = read_text(read_stl, binary_stl(facets, ""));
  EXPECT_EQ(mesh.vertices.size(), std::size_t{kSide + 1} * (kSide + 1));
  ASSERT_EQ(mesh.triangles.size(), facets.size());
  std::uint32_t next = 0;  // vertices are numbered as they appear
  for (std::size_t t = 0; t < facets.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t index = mesh.triangles[t][c];
      ASSERT_EQ(mesh.vertices[index], facets[t][c]);
      ASSERT_LE(index, next);
      if (index == next) ++next;
    }
}

TEST(StlReader, RefusalsNameThePlaceAndTheReason) {
  EXPECT_EQ(refusal(read_stl, ""), "mesh: the file is empty");
  EXPECT_EQ(refusal(read_stl, "hello"),
            "mesh: not an STL file: it is not ASCII STL, and it is too short for binary STL");
  const std::string binary = binary_stl(kFacets, "");
  EXPECT_EQ(refusal(read_stl, binary.substr(0, 180)),
            "mesh: byte 180: the file ends after 1 of 2 facets");
  EXPECT_EQ(refusal(read_stl, binary_stl({}, "")),
            "mesh: STL with 0 facets: there is no surface to read");
  EXPECT_EQ(refusal(read_stl, binary_stl({{{{0, 0, 0}, {1, 0, NAN}, {0, 1, 0}}}}, "")),
            "mesh: byte 108: vertex is not finite");
  EXPECT_EQ(refusal(read_stl, "solid\nendsolid\n"),
            "mesh: STL without facets: there is no surface to read");
  const auto without = [](std::string_view part) {
    std::string text = kTwoFacets;
    return text.erase(text.find(part), part.size());
  };
  EXPECT_EQ(refusal(read_stl, without("   vertex 1 1 0\n")),
            "mesh: line 6: expected 'vertex', not 'endloop'");
  EXPECT_EQ(refusal(read_stl, without("endsolid a facet of life\n")),
            "mesh: line 14: the file ends before 'endsolid'");
  EXPECT_EQ(refusal(read_stl, without(" 0 1 1.5e0 ENDLOOP")),
            "mesh: line 13: coordinate 'ENDFACET' is not a number");
}

TEST(StlReader, AnyPrefixIsSafe) {
  expect_any_prefix_is_safe(read_stl, kTwoFacets);
  expect_any_prefix_is_safe(read_stl, binary_stl(kFacets, "solid"));
}

}  // namespace
}  // namespace voxdag
