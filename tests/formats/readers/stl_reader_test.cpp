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

MeshWithAppearance read_bytes(const std::string& bytes) {
  return read_stl({bytes, "mesh", {}, nullptr, {}}, ReadParts::kMeshAndAppearance);
}

/// Returns a text with every `from` replaced.
std::string with_all(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != text.npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

TEST(StlReader, WordsThatAreMissingDoubledOrSplitAreAWarning) {
  const auto expect_read = [](const std::string& text, int irregular) {
    const auto read = read_bytes(text);
    EXPECT_EQ(read.mesh.triangles, kTriangles) << text;
    ASSERT_EQ(read.warnings.size(), irregular == 0 ? 0u : 1u) << text;
    if (irregular > 0) {
      EXPECT_EQ(read.warnings[0].find("mesh: " + std::to_string(irregular) + " keyword"), 0u)
          << text;
    }
  };
  const std::string end = "endsolid a facet of life\n", start = "solid a facet of life\n";
  expect_read(kTwoFacets, 0);
  expect_read(with_all(kTwoFacets, "endsolid", "end solid"), 1);
  expect_read(with_all(with_all(kTwoFacets, "endloop", "end loop"), "endfacet", "end facet"), 2);
  expect_read(with_all(kTwoFacets, end, ""), 1);
  expect_read(kTwoFacets + end, 1);
  expect_read(start + kTwoFacets, 1);
  expect_read("solid\nendsolid\n" + kTwoFacets.substr(start.size()), 1);
  expect_read(kTwoFacets.substr(start.size()), 1);
  expect_read(with_all(kTwoFacets, " normal 0 0 1", ""), 1);
  expect_read(with_all(kTwoFacets, " normal 0 0 1", " normal"), 1);
  expect_read(kTwoFacets + std::string(3, '\0'), 0);
  expect_read(kTwoFacets + "\x1A", 0);
}

TEST(StlReader, AFileMayBeOneLine) {
  for (const char* name : {"", "a ", "facet normal of life "}) {
    std::string text = with_all(with_all(kTwoFacets, "a facet of life", name), "\n", " ");
    EXPECT_TRUE(is_ascii_stl(text)) << text;
    const auto read = read_bytes(text);
    EXPECT_EQ(read.mesh.triangles, kTriangles) << text;
    EXPECT_TRUE(read.warnings.empty()) << text;
  }
}

TEST(StlReader, BinaryFilesMayBeginWithSolidAndHaveTrailingBytes) {
  const auto read = read_bytes(binary_stl(kFacets, "solid part (exported)") + "\r\n");
  EXPECT_EQ(read.mesh.triangles, kTriangles);
  EXPECT_EQ(read.warnings, std::vector<std::string>{"mesh: ignored 2 bytes after the last facet"});
}

TEST(StlReader, ACountThatWasNeverWrittenIsThatOfTheSize) {
  for (const char byte : {'\0', '\xFF'}) {
    std::string bytes = binary_stl(kFacets, "streamed");
    bytes.replace(80, 4, 4, byte);
    const auto read = read_bytes(bytes);
    EXPECT_EQ(read.mesh.triangles, kTriangles);
    ASSERT_EQ(read.warnings.size(), 1u);
    EXPECT_NE(read.warnings[0].find("the size of the file is that of 2"), std::string::npos);
    EXPECT_NE(refusal(read_stl, bytes + "?"), "");
  }
}

TEST(StlReader, ACountThatIsTooSmallIsThatOfTheSize) {
  std::string bytes = binary_stl(kFacets, "");
  bytes[80] = 1;
  const auto read = read_bytes(bytes);
  EXPECT_EQ(read.mesh.triangles, kTriangles);
  EXPECT_EQ(read.warnings,
            std::vector<std::string>{"mesh: the header says 1 facet, but the size of "
                                     "the file is that of 2: all are read"});
  // Zeros are padding, and bytes that are no finite numbers are no facets.
  for (const char byte : {'\0', '\xFF'}) {
    const auto padded = read_bytes(binary_stl(kFacets, "") + std::string(100, byte));
    EXPECT_EQ(padded.mesh.triangles, kTriangles);
    EXPECT_EQ(padded.warnings,
              std::vector<std::string>{"mesh: ignored 100 bytes after the last facet, room for 2 "
                                       "more facets"});
  }
}

TEST(StlReader, ASecondFileInTheFileIsAWarning) {
  const std::string bytes = binary_stl(kFacets, "");
  const auto read = read_bytes(bytes + bytes);
  EXPECT_EQ(read.mesh.triangles, kTriangles);
  EXPECT_EQ(read.warnings,
            std::vector<std::string>{
                "mesh: ignored 184 bytes after the last facet: another STL file of 2 facets"});
}

TEST(StlReader, FacetsMayHaveColours) {
  const Rgba16 red{65535, 0, 0, 65535}, blue{0, 0, 65535, 65535},
      grey = to_rgba16(kDefaultColor, 1);
  const auto colors_of = [](std::string header, std::uint16_t first, std::uint16_t second) {
    std::string bytes = binary_stl(kFacets, std::move(header));
    std::string words;
    append(words, first);
    append(words, second);
    bytes.replace(84 + 48, 2, words.substr(0, 2)).replace(84 + 98, 2, words.substr(2));
    const auto read = read_bytes(bytes);
    const std::vector<Rgba16>& colors = read.appearance.colors;
    return colors.empty() ? std::vector<Rgba16>{} : std::vector{colors[2], colors[3]};
  };
  using Colors = std::vector<Rgba16>;
  EXPECT_EQ(colors_of("", 0, 0), Colors{});
  EXPECT_EQ(colors_of("", 31, 7), Colors{});  // attributes of another kind
  EXPECT_EQ(colors_of("", 0x8000 | 31 << 10, 0x8000 | 31), (Colors{red, blue}));
  EXPECT_EQ(colors_of("", 0x8000 | 31 << 10, 0), (Colors{red, grey}));
  const std::string magics = "COLOR=\xFF" + std::string("\0\0\xFF", 3);
  EXPECT_EQ(colors_of(magics, 0, 0), (Colors{red, red}));
  EXPECT_EQ(colors_of(magics, 31 << 10, 0x8000), (Colors{blue, red}));
  EXPECT_EQ(colors_of("by hand " + magics, 31, 0xFFFF), (Colors{red, red}));
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
    EXPECT_FALSE(is_finite(read_text(read_stl, first_x(word)).vertices[1])) << word;
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
  EXPECT_EQ(refusal(read_stl, "# made by hand\n" + kTwoFacets),
            "mesh: not an STL file: text that does not begin with 'solid' or 'facet'");
  std::string utf16 = "\xFF\xFE";
  for (const char c : kTwoFacets) utf16 += {c, '\0'};
  EXPECT_EQ(refusal(read_stl, utf16), "mesh: STL in UTF-16: save it as ASCII or UTF-8");
  const std::string binary = binary_stl(kFacets, "");
  EXPECT_EQ(refusal(read_stl, binary.substr(0, 180)),
            "mesh: byte 180: the file ends after 1 of 2 facets");
  EXPECT_EQ(refusal(read_stl, binary_stl({}, "")),
            "mesh: STL with 0 facets: there is no surface to read");
  EXPECT_EQ(refusal(read_stl, "solid\nendsolid\n"),
            "mesh: STL without facets: there is no surface to read");
  const auto without = [](std::string_view part) {
    std::string text = kTwoFacets;
    return text.erase(text.find(part), part.size());
  };
  EXPECT_EQ(refusal(read_stl, without("   vertex 1 1 0\n")),
            "mesh: line 6: expected 'vertex', not 'endloop'");
  EXPECT_EQ(refusal(read_stl, without(" 0 1 1.5e0 ENDLOOP")),
            "mesh: line 13: coordinate 'ENDFACET' is not a number");
}

TEST(StlReader, AnyPrefixIsSafe) {
  expect_any_prefix_is_safe(read_stl, kTwoFacets);
  expect_any_prefix_is_safe(read_stl, binary_stl(kFacets, "solid"));
}

}  // namespace
}  // namespace voxdag
