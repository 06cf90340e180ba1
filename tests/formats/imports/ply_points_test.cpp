// PLY files as points: all variants against the points that were written.
#include "point_checks.hpp"

namespace voxdag {
namespace {

class PlyPointsTest : public PointFile {
 protected:
  PlyPointsTest() : PointFile(".ply") {}
};

const char* const kFormats[] = {"ascii", "binary_little_endian", "binary_big_endian"};

/// Writes a header, then values as text or binary.
class PlyWriter {
 public:
  explicit PlyWriter(const std::string& format)
      : is_text_(format == "ascii"),
        is_big_(format == "binary_big_endian"),
        bytes_("ply\nformat " + format + " 1.0\n") {}

  PlyWriter& line(const std::string& line) {
    bytes_ += line + "\n";
    return *this;
  }
  template <class T>
  PlyWriter& value(T value) {
    if (is_text_)
      bytes_ += (std::is_floating_point_v<T> ? to_text(static_cast<double>(value))
                                             : std::to_string(static_cast<long long>(value))) +
                " ";
    else
      append(bytes_, value, is_big_);
    return *this;
  }
  PlyWriter& end_row() {
    if (is_text_) bytes_ += "\n";
    return *this;
  }
  const std::string& bytes() const { return bytes_; }

 private:
  static std::string to_text(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.17g", value);
    return text;
  }

  bool is_text_, is_big_;
  std::string bytes_;
};

TEST_F(PlyPointsTest, AllFormatsGiveTheSamePoints) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const PointCloud cloud = random_cloud(5'000, seed);
    for (const char* const format : kFormats) {
      PlyWriter ply(format);
      ply.line("element vertex 5000").line("property float x").line("property double y");
      ply.line("property float z").line("end_header");
      for (const Vec3d p : cloud.places)
        ply.value(static_cast<float>(p.x)).value(p.y).value(static_cast<float>(p.z)).end_row();
      EXPECT_EQ(read(ply.bytes()), (PointCloud{cloud.places, {}})) << format;
      expect_voxels(ply.bytes(), cloud.places);
    }
  }
}

/// Returns a file with lists and elements before, inside and behind the vertices.
std::string crowded_ply(const std::string& format, const PointCloud& cloud) {
  PlyWriter ply(format);
  ply.line("comment crowded").line("element nothing 7").line("element camera 2");
  ply.line("property list uchar short path").line("property double angle");
  ply.line("property list ushort double weights").line("element plain 3");
  ply.line("property int a").line("property char b");
  ply.line("element vertex " + std::to_string(cloud.places.size()));
  ply.line("property list int uchar tags").line("property uchar blue").line("property double z");
  ply.line("property double x").line("property list uchar float more").line("property uchar red");
  ply.line("property double y").line("property uchar green").line("property uchar alpha");
  ply.line("element face 1").line("property list uchar int vertex_indices");
  ply.line("element tristrips 1").line("property list int int vertex_indices").line("end_header");
  for (int i = 0; i < 2; ++i) {
    ply.value(std::uint8_t{3}).value(std::int16_t{1}).value(std::int16_t{-2});
    ply.value(std::int16_t{3}).value(0.5).value(static_cast<std::uint16_t>(i));
    for (int k = 0; k < i; ++k) ply.value(2.5);
    ply.end_row();
  }
  for (int i = 0; i < 3; ++i) ply.value(i).value(std::int8_t{-1}).end_row();
  for (std::size_t i = 0; i < cloud.places.size(); ++i) {
    const Vec3d p = cloud.places[i];
    const Rgb8 c = cloud.colors[i];
    ply.value(static_cast<std::int32_t>(i % 3));
    for (std::size_t k = 0; k < i % 3; ++k) ply.value(std::uint8_t{9});
    ply.value(c[2]).value(p.z).value(p.x).value(std::uint8_t{1}).value(1.5f);
    ply.value(c[0]).value(p.y).value(c[1]).value(std::uint8_t{255}).end_row();
  }
  ply.value(std::uint8_t{3}).value(0).value(1).value(2).end_row();
  ply.value(3).value(0).value(1).value(2).end_row();
  return ply.bytes();
}

TEST_F(PlyPointsTest, OtherElementsAndListsAreSkipped) {
  const PointCloud cloud = random_cloud(1'000, 4);
  for (const char* const format : kFormats) EXPECT_EQ(read(crowded_ply(format, cloud)), cloud);
}

TEST_F(PlyPointsTest, CoordinatesMayHaveAnyType) {
  const auto expect = [&]<class T>(const char* type, T x) {
    for (const char* const format : kFormats) {
      PlyWriter ply(format);
      ply.line("element vertex 1").line(std::string("property ") + type + " x");
      ply.line("property int8 y").line("property uint32 z").line("end_header");
      ply.value(x).value(std::int8_t{-7}).value(std::uint32_t{4'000'000'000}).end_row();
      EXPECT_EQ(read(ply.bytes()).places, (std::vector<Vec3d>{{static_cast<double>(x), -7, 4e9}}))
          << type;
    }
  };
  expect("char", std::int8_t{-128});
  expect("uchar", std::uint8_t{200});
  expect("int16", std::int16_t{-30'000});
  expect("ushort", std::uint16_t{60'000});
  expect("int", std::int32_t{-2'000'000'000});
  expect("uint", std::uint32_t{3'000'000'001});
  expect("float32", 0.1f);
  expect("double", 0.1);
}

TEST_F(PlyPointsTest, ColoursAreScaledToEightBits) {
  const auto expect = [&]<class T>(const std::string& type, const std::array<std::string, 3>& names,
                                   std::array<T, 3> values, Rgb8 color) {
    for (const char* const format : kFormats) {
      PlyWriter ply(format);
      ply.line("element vertex 1").line("property float x").line("property float y");
      ply.line("property float z");
      for (const std::string& name : names) ply.line("property " + type + " " + name);
      ply.line("end_header").value(1.0f).value(2.0f).value(3.0f);
      for (const T value : values) ply.value(value);
      EXPECT_EQ(read(ply.end_row().bytes()), (PointCloud{{{1, 2, 3}}, {color}})) << type;
    }
  };
  using Shorts = std::array<std::uint16_t, 3>;
  using Floats = std::array<float, 3>;
  expect("uchar", {"r", "g", "b"}, std::array<std::uint8_t, 3>{0, 127, 255}, {0, 127, 255});
  expect("ushort", {"diffuse_red", "diffuse_green", "diffuse_blue"}, Shorts{0, 32'896, 65'535},
         {0, 128, 255});
  expect("float", {"red", "green", "blue"}, Floats{0.5f, 1.5f, -1.0f}, {128, 255, 0});
  expect("double", {"red", "green", "blue"}, std::array<double, 3>{0.2, 1, 0}, {51, 255, 0});
  expect("ushort", {"R", "G", "B"}, Shorts{255, 128, 0}, {255, 128, 0});
  expect("short", {"r", "g", "b"}, std::array<std::int16_t, 3>{255, 128, 0}, {255, 128, 0});
  // A colour needs all three components.
  EXPECT_TRUE(read("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
                   "property float z\nproperty uchar red\nend_header\n1 2 3 4\n")
                  .colors.empty());
}

TEST_F(PlyPointsTest, NamesMayHaveCapitalsAndSixteenBitsMayHoldEight) {
  const auto text = [](const char* type, const char* red) {
    return std::string(
               "ply\nformat ascii 1.0\nelement vertex 1\nproperty float X\nproperty float "
               "Y\nproperty float Z\n") +
           "property " + type + " Red\nproperty " + type + " Green\nproperty " + type +
           " Blue\nend_header\n1 2 3 " + red + " 128 0\n";
  };
  EXPECT_EQ(read(text("uchar", "255")), (PointCloud{{{1, 2, 3}}, {{255, 128, 0}}}));
  EXPECT_TRUE(warnings(text("uchar", "255")).empty());
  EXPECT_EQ(warnings(text("ushort", "255")), kTakenAs255);
  EXPECT_TRUE(warnings(text("ushort", "256")).empty());
}

TEST_F(PlyPointsTest, EveryColourOfEightBitsIsKept) {
  std::string text =
      "ply\nformat ascii 1.0\nelement vertex 256\nproperty float x\nproperty float y\nproperty "
      "float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n";
  for (int i = 0; i < 256; ++i)
    text += "0 0 0 " + std::to_string(i) + " 0 " + std::to_string(255 - i) + "\n";
  const PointCloud cloud = read(text);
  for (std::size_t i = 0; i < 256; ++i)
    EXPECT_EQ(cloud.colors[i],
              (Rgb8{static_cast<std::uint8_t>(i), 0, static_cast<std::uint8_t>(255 - i)}));
}

constexpr const char* kHeader =
    "property float x\nproperty float y\nproperty float z\nend_header\n";

TEST_F(PlyPointsTest, TextMayHaveOtherLineEndsAndBlankLines) {
  const std::string text =
      "ply\nformat ascii 1.0\nelement vertex 2\n" + std::string(kHeader) + "\n1 2 3\n\n  4\t5 6e0";
  const PointCloud expected{{{1, 2, 3}, {4, 5, 6}}, {}};
  EXPECT_EQ(read(text), expected);
  std::string carriage = text, both;
  std::replace(carriage.begin(), carriage.end(), '\n', '\r');
  EXPECT_EQ(read(carriage), expected);
  for (const char c : text) both += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(read(both), expected);
}

TEST_F(PlyPointsTest, DamagedFilesAreRefusedOrSafe) {
  for (const char* const format : kFormats) {
    const std::string good = crowded_ply(format, random_cloud(4, 5));
    // The faces and strips may be cut, and digits of the last number of text.
    const bool is_text = std::string(format) == "ascii";
    expect_damage_is_safe(good, good.size() - (is_text ? 22 : 29));
  }
}

TEST_F(PlyPointsTest, BadFilesAreRefusedWithTheirPlace) {
  const auto text = [](const std::string& vertices, const std::string& rows) {
    return "ply\nformat ascii 1.0\nelement vertex " + vertices + "\n" + kHeader + rows;
  };
  expect_error("", "the file is empty");
  expect_error("plx\n", "not a PLY file");
  expect_error(text("9223372036854775807", "1 2 3\n"), "the file is too short");
  expect_error(text("99999999999999999999", "1 2 3\n"), "is not a number");
  expect_error(text("2", "1 2 3\n\n\n\n\n\n\n\n"), "after 1 of 2 rows of element 'vertex'");
  expect_error(text("1", "1 2 x\n"), "line 8: coordinate 'x' is not a number");
  expect_error(text("1", "1 2\n3\n"), "line 8: the row ends before property 'z'");
  expect_error(text("1", "1 2 3 4\n"), "line 8: the row has '4' after its last property");
  expect_error("ply\nformat ascii 1.0\nelement face 0\nend_header\n", "without a 'vertex' element");
  // Counts of two elements that fit alone, but not together.
  PlyWriter two("binary_big_endian");
  two.line("element a 3").line("property int i").line("element vertex 1").line("property int x");
  two.line("property int y").line("property int z").line("end_header").value(1).value(2).value(3);
  expect_error(two.bytes(), "the file ends inside a row");
  // A list before the vertices that is longer than the file.
  PlyWriter list("binary_little_endian");
  list.line("element a 1").line("property list uint double i").line("element vertex 0");
  list.line("property int x").line("property int y").line("property int z").line("end_header");
  expect_error(list.value(std::uint32_t{4'000'000'000}).bytes(),
               "a list of 4000000000 items does not fit");
}

TEST_F(PlyPointsTest, PointsThatAreNotFiniteAreCounted) {
  ImportOptions options;
  options.voxel_size = 1;
  options.folder = dir_.path();
  write_text(path_, std::string("ply\nformat ascii 1.0\nelement vertex 4\n") + kHeader +
                        "1 2 3\n1 nan 3\n1 2 1e999\n-inf 0 0\n");
  ImportResult result = import_voxels(*open_voxel_source(path_), options);
  EXPECT_EQ(result.read, 4u);
  EXPECT_EQ(result.not_finite, 3u);
  EXPECT_EQ(result.dag, brute_svdag(2, {{0, 0, 0}}));
  PlyWriter ply("binary_little_endian");
  ply.line("element vertex 2").line("property float x").line("property float y");
  ply.line("property float z").line("end_header");
  ply.value(1.0f).value(HUGE_VALF).value(0.0f).value(1.0f).value(2.0f).value(3.0f);
  write_text(path_, ply.bytes());
  result = import_voxels(*open_voxel_source(path_), options);
  EXPECT_EQ(result.not_finite, 1u);
}

TEST_F(PlyPointsTest, ColoursOfRealNumbersMayGoTo255) {
  const auto text = [](const std::string& names, const std::string& rows) {
    return "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
           "property float z\n" +
           names + "end_header\n" + rows;
  };
  const std::string rgb = "property float red\nproperty float green\nproperty double blue\n";
  EXPECT_EQ(read(text(rgb, "0 0 0 255 128 0\n1 0 0 16.4 7.6 0\n")).colors,
            (std::vector<Rgb8>{{255, 128, 0}, {16, 8, 0}}));
  EXPECT_EQ(read(text(rgb, "0 0 0 1 0.5 0\n1 0 0 nan 1.9 -3\n")).colors,
            (std::vector<Rgb8>{{255, 128, 0}, {0, 255, 0}}));
}

TEST_F(PlyPointsTest, GaussianSplatsHaveTheColourOfTheirFirstHarmonic) {
  for (const char* const format : kFormats) {
    PlyWriter ply(format);
    ply.line("element vertex 2");
    for (const char* name :
         {"x", "y", "z", "nx", "ny", "nz", "f_dc_0", "f_dc_1", "f_dc_2", "opacity"})
      ply.line(std::string("property float ") + name);
    ply.line("end_header");
    for (const float v : {1.0f, 2.0f, 3.0f, 0.0f, 0.0f, 0.0f, 1.7724539f, -1.7724539f, 0.0f, 5.0f})
      ply.value(v);
    ply.end_row();
    for (const float v : {4.0f, 5.0f, 6.0f, 0.0f, 0.0f, 0.0f, 9.0f, -9.0f, 0.5f, 5.0f})
      ply.value(v);
    EXPECT_EQ(read(ply.end_row().bytes()),
              (PointCloud{{{1, 2, 3}, {4, 5, 6}}, {{255, 0, 128}, {255, 0, 163}}}))
        << format;
  }
}

TEST_F(PlyPointsTest, FilesWithoutPointsAreEmpty) {
  EXPECT_EQ(read("ply\nformat ascii 1.0\nelement vertex 0\n" + std::string(kHeader)), PointCloud{});
}

}  // namespace
}  // namespace voxdag
