// PCD files of every kind of data, against the points that were written.
#include "lzf_text.hpp"
#include "point_checks.hpp"
#include "voxdag/formats/imports/points/lzf_stream.hpp"
#include "voxdag/formats/readers/chunks.hpp"

namespace voxdag {
namespace {

class PcdPointsTest : public PointFile {
 protected:
  PcdPointsTest() : PointFile(".pcd") {}
};

const char* const kKinds[] = {"ascii", "binary", "binary_compressed"};

struct Field {
  std::string name;
  char type;
  int size;
  int count = 1;
};

/// Writes a value of a field as text or binary.
void append_value(std::string& bytes, const Field& field, double value, bool is_text) {
  const bool is_float = field.type == 'F';
  if (is_text) {
    char text[40];
    std::snprintf(text, sizeof text, is_float ? "%.17g " : "%.0f ", value);
    bytes += text;
  } else if (is_float) {
    field.size == 4 ? append(bytes, static_cast<float>(value)) : append(bytes, value);
  } else {
    const auto whole = static_cast<std::int64_t>(value);
    bytes.append(reinterpret_cast<const char*>(&whole), static_cast<std::size_t>(field.size));
  }
}

struct PcdFile {
  std::vector<Field> fields{};
  std::string kind = "ascii";
  std::string version = ".7";
  std::string size{};  ///< The lines WIDTH, HEIGHT, POINTS; empty: made from the points.
};

/// Returns a file; `value(point, field, k)` is the k-th value of a field.
template <class Value>
std::string pcd_of(const PcdFile& pcd, std::size_t points, const Value& value) {
  std::string fields = "FIELDS", sizes = "SIZE", types = "TYPE", counts = "COUNT";
  for (const Field& field : pcd.fields) {
    fields += " " + field.name;
    sizes += " " + std::to_string(field.size);
    types += std::string(" ") + field.type;
    counts += " " + std::to_string(field.count);
  }
  const std::string n = std::to_string(points);
  std::string bytes = "# .PCD v" + pcd.version + "\nVERSION " + pcd.version + "\n" + fields + "\n" +
                      sizes + "\n" + types + "\n" + counts + "\n" +
                      (pcd.size.empty() ? "WIDTH " + n + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\n" +
                                              "POINTS " + n + "\n"
                                        : pcd.size) +
                      "DATA " + pcd.kind + "\n";
  std::string body;
  if (pcd.kind == "binary_compressed") {
    for (const Field& field : pcd.fields)
      for (std::size_t i = 0; i < points; ++i)
        for (int k = 0; k < field.count; ++k)
          append_value(body, field, value(i, field.name, k), false);
    const std::string compressed = lzf_of(body);
    append(bytes, static_cast<std::uint32_t>(compressed.size()));
    append(bytes, static_cast<std::uint32_t>(body.size()));
    return bytes + compressed;
  }
  for (std::size_t i = 0; i < points; ++i) {
    for (const Field& field : pcd.fields)
      for (int k = 0; k < field.count; ++k)
        append_value(body, field, value(i, field.name, k), pcd.kind == "ascii");
    if (pcd.kind == "ascii") body += "\n";
  }
  return bytes + body;
}

/// Returns a file of a cloud; other fields than x, y, z and the colour have any values.
std::string pcd_of(const PcdFile& pcd, const PointCloud& cloud) {
  return pcd_of(pcd, cloud.places.size(), [&](std::size_t i, const std::string& name, int k) {
    const Vec3d p = cloud.places[i];
    if (name == "x") return p.x;
    if (name == "y") return p.y;
    if (name == "z") return p.z;
    const Rgb8 c = cloud.colors[i];
    if (name == "rgb" || name == "rgba") return c[0] * 65536.0 + c[1] * 256.0 + c[2];
    return static_cast<double>((7 * i + static_cast<std::size_t>(k)) % 100);
  });
}

PcdFile plain(const std::string& kind) {
  PcdFile pcd;
  pcd.fields = {{"x", 'F', 4}, {"y", 'F', 4}, {"z", 'F', 4}};
  pcd.kind = kind;
  return pcd;
}

TEST_F(PcdPointsTest, AllKindsGiveTheSamePoints) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    const PointCloud cloud = random_cloud(10'000, seed);
    for (const char* const kind : kKinds) {
      const std::string bytes = pcd_of(plain(kind), cloud);
      EXPECT_EQ(read(bytes), (PointCloud{cloud.places, {}})) << kind;
      expect_voxels(bytes, cloud.places);
    }
  }
}

TEST_F(PcdPointsTest, FieldsMayHaveAnyOrderTypeAndCount) {
  const PointCloud cloud = random_cloud(5'000, 4);
  for (const char* const kind : kKinds)
    for (const char* const version : {".5", "0.6", "0.7"}) {
      PcdFile pcd;
      pcd.kind = kind;
      pcd.version = version;
      pcd.fields = {{"_", 'U', 1, 5}, {"z", 'F', 8},     {"histogram", 'F', 4, 7},
                    {"rgba", 'U', 4}, {"label", 'I', 2}, {"y", 'F', 4},
                    {"time", 'U', 8}, {"x", 'F', 8},     {"intensity", 'I', 1}};
      EXPECT_EQ(read(pcd_of(pcd, cloud)), cloud) << kind;
    }
}

TEST_F(PcdPointsTest, CoordinatesMayBeIntegers) {
  const std::vector<std::pair<Field, double>> cases = {
      {{"x", 'I', 1}, -128},   {{"x", 'U', 1}, 255},  {{"x", 'I', 2}, -30'000},
      {{"x", 'U', 2}, 60'000}, {{"x", 'I', 4}, -2e9}, {{"x", 'U', 4}, 4e9},
      {{"x", 'I', 8}, -1e15},  {{"x", 'U', 8}, 1e18}};
  for (const char* const kind : kKinds)
    for (const auto& [field, value] : cases) {
      PcdFile pcd = plain(kind);
      pcd.fields[0] = field;
      const PointCloud cloud{{{value, 2, 3}}, {{}}};
      EXPECT_EQ(read(pcd_of(pcd, cloud)).places, cloud.places) << field.type << field.size;
    }
}

TEST_F(PcdPointsTest, PackedColoursAreIntegersOrFloats) {
  const PointCloud cloud{{{1, 2, 3}, {4, 5, 6}}, {{1, 2, 3}, {255, 128, 0}}};
  for (const char* const kind : kKinds)
    for (const char* const name : {"rgb", "rgba"})
      for (const char type : {'U', 'I', 'F'}) {
        PcdFile pcd = plain(kind);
        pcd.fields.push_back({name, type, 4});
        const std::string bytes = pcd_of(pcd, 2, [&](std::size_t i, const std::string& field, int) {
          if (field[0] != 'r') return cloud.places[i][field[0] - 'x'];
          const Rgb8 c = cloud.colors[i];
          const std::uint32_t packed =
              static_cast<std::uint32_t>(c[0]) << 16 | static_cast<std::uint32_t>(c[1]) << 8 | c[2];
          float value;
          std::memcpy(&value, &packed, sizeof value);
          return type == 'F' ? static_cast<double>(value) : static_cast<double>(packed);
        });
        EXPECT_EQ(read(bytes), cloud) << kind << type;
      }
  // Text of type F with only digits is an integer, as newer programs write it.
  const auto text = [](const std::string& color) {
    return "FIELDS x y z rgb\nPOINTS 1\nDATA ascii\n1 2 3 " + color + "\n";
  };
  EXPECT_EQ(read(text("4278255360")).colors, (std::vector<Rgb8>{{0, 255, 0}}));
  EXPECT_EQ(read(text("-16777216")).colors, (std::vector<Rgb8>{{0, 0, 0}}));
  EXPECT_EQ(read(text("2.3418052e-38")).colors, (std::vector<Rgb8>{{255, 0, 0}}));
  EXPECT_EQ(read(text("nan")).colors, (std::vector<Rgb8>{{0, 0, 0}}));
  expect_error(text("4294967296"), "line 4: colour '4294967296' has more than 32 bits");
  expect_error(text("red"), "line 4: colour 'red' is not a number");
  // Fields of other sizes are no colours.
  EXPECT_TRUE(read("FIELDS x y z rgb\nSIZE 4 4 4 1\nTYPE F F F U\nCOUNT 1 1 1 3\nPOINTS 1\n"
                   "DATA ascii\n1 2 3 4 5 6\n")
                  .colors.empty());
}

TEST_F(PcdPointsTest, ColoursMayBeThreeFields) {
  const PointCloud cloud{{{1, 2, 3}, {4, 5, 6}}, {{1, 2, 3}, {255, 128, 0}}};
  struct Channel {
    char type;
    int size;
    double scale;  ///< Of 8 bits.
  };
  for (const char* const kind : kKinds)
    for (const auto& [type, size, scale] : {Channel{'U', 1, 1},
                                            {'U', 2, 257},
                                            {'U', 2, 1},
                                            {'I', 4, 1},
                                            {'F', 4, 1},
                                            {'F', 8, 1 / 255.0}}) {
      PcdFile pcd = plain(kind);
      for (const char* const name : {"b", "g", "r"}) pcd.fields.push_back({name, type, size});
      const auto value = [&, scale = scale](std::size_t i, const std::string& name, int) {
        if (name[0] >= 'x') return cloud.places[i][name[0] - 'x'];
        const Rgb8 c = cloud.colors[i];
        return scale * c[name == "r" ? 0 : name == "g" ? 1 : 2];
      };
      EXPECT_EQ(read(pcd_of(pcd, 2, value)), cloud) << kind << type << size;
      EXPECT_EQ(warnings(pcd_of(pcd, 2, value)),
                size == 2 && scale == 1 ? kTakenAs255 : std::vector<std::string>());
    }
  EXPECT_TRUE(read("FIELDS x y z r g\nPOINTS 1\nDATA ASCII\n1 2 3 4 5\n").colors.empty());
  expect_error("FIELDS x y z r g b\nPOINTS 1\nDATA ascii\n1 2 3 4 5 red\n",
               "line 4: colour 'red' is not a number");
}

TEST_F(PcdPointsTest, PointsThatAreNotFiniteAreLeftOut) {
  PointCloud cloud = random_cloud(100, 6);
  std::vector<Vec3d> kept;
  for (std::size_t i = 0; i < cloud.places.size(); ++i) {
    if (i % 3 == 0) cloud.places[i].x = std::nan("");
    if (i % 7 == 0) cloud.places[i].z = -HUGE_VAL;
    if (is_finite(cloud.places[i])) kept.push_back(cloud.places[i]);
  }
  for (const char* const kind : kKinds) {
    PcdFile pcd = plain(kind);
    pcd.fields.push_back({"rgb", 'U', 4});
    pcd.size = "WIDTH 20\nHEIGHT 5\nPOINTS 100\n";
    write_text(path_, pcd_of(pcd, cloud));
    ImportOptions options;
    options.resolution = 64;
    options.folder = dir_.path();
    const ImportResult result = import_voxels(*open_voxel_source(path_), options);
    EXPECT_EQ(result.read, 100u);
    EXPECT_EQ(result.not_finite, 100 - kept.size());
    const PointLocator locator(result.grid, kFloatCoordinates);
    std::vector<Vec3i> voxels;
    for (const Vec3d p : kept) voxels.push_back(locator.voxel_in_box(p));
    EXPECT_EQ(result.dag, brute_svdag(6, voxels)) << kind;
  }
}

TEST_F(PcdPointsTest, FieldsMayHaveNoValues) {
  const PointCloud cloud = random_cloud(100, 3);
  for (const char* const kind : kKinds) {
    PcdFile pcd = plain(kind);
    pcd.fields.insert(pcd.fields.begin() + 1, {"_", 'U', 1, 0});
    pcd.fields.push_back({"_", 'U', 4, 0});
    EXPECT_EQ(read(pcd_of(pcd, cloud)), (PointCloud{cloud.places, {}})) << kind;
  }
  expect_error("FIELDS x y z\nCOUNT 0 0 0\nPOINTS 1\nDATA binary\n", "the points have no values");
  expect_error("FIELDS x y z\nCOUNT 1 0 1\nPOINTS 1\nDATA ascii\n1 2 3\n",
               "field 'y' has 0 values instead of one");
}

TEST_F(PcdPointsTest, CompressedDataMayBeStored) {
  const PointCloud cloud = random_cloud(5'000, 9);
  PcdFile pcd = plain("binary");
  pcd.fields.push_back({"rgb", 'U', 4});
  std::string bytes = pcd_of(pcd, 5'000, [](std::size_t, const std::string&, int) { return 0.0; });
  bytes = bytes.substr(0, bytes.find("DATA")) + "DATA binary_compressed\n";
  for (int i = 0; i < 2; ++i) append(bytes, std::uint32_t{5'000 * 16});
  for (int axis = 0; axis < 3; ++axis)
    for (const Vec3d p : cloud.places) append(bytes, static_cast<float>(p[axis]));
  for (const Rgb8 c : cloud.colors)
    append(bytes,
           static_cast<std::uint32_t>(c[0]) << 16 | static_cast<std::uint32_t>(c[1]) << 8 | c[2]);
  EXPECT_EQ(read(bytes), cloud);
}

TEST_F(PcdPointsTest, OldHeadersLackLines) {
  const PointCloud two{{{1, 2, 3}, {4, 5, 6}}, {}};
  EXPECT_EQ(read("COLUMNS x y z\nPOINTS 2\nDATA ascii\n1 2 3\n4 5 6"), two);
  EXPECT_EQ(read("FIELDS x y z\r\nWIDTH 2\r\nDATA ascii\r\n1 2 3\r\n\r\n4 5 6\r\n"), two);
  EXPECT_EQ(read("FIELDS x y z\nHEIGHT 1\nWIDTH 2\nPOINTS 2\nDATA ascii\n1 2 3\n4 5 6"), two);
  for (const char* const kind : kKinds) EXPECT_EQ(read(pcd_of(plain(kind), {})), PointCloud{});
}

TEST_F(PcdPointsTest, DamagedFilesAreRefusedOrSafe) {
  for (const char* const kind : kKinds) {
    PcdFile pcd = plain(kind);
    pcd.fields.insert(pcd.fields.begin() + 1, {"rgb", 'U', 4});
    const std::string good = pcd_of(pcd, random_cloud(6, 8));
    // Digits of the last number of text may be cut.
    expect_damage_is_safe(
        good, std::string(kind) == "ascii" ? good.rfind(' ', good.size() - 3) + 2 : good.size());
  }
}

TEST_F(PcdPointsTest, BadHeadersAreRefusedWithTheirPlace) {
  const auto header = [](const std::string& lines) { return lines + "DATA ascii\n1 2 3\n"; };
  expect_error("", "the file is empty");
  expect_error("FIELDS x y z\nPOINTS 1\n", "line 2: the file ends before the line DATA");
  expect_error("ply\n", "line 1: not a PCD file");
  expect_error("VERSION .7\nFIELD x\n", "line 2: unknown PCD header keyword 'FIELD'");
  expect_error("VERSION .8\n", "line 1: PCD version '.8' is not 0.5, 0.6 or 0.7");
  expect_error(std::string(1 << 21, '\n'), "no line DATA in its first MiB");
  expect_error(header("POINTS 1\n"), "line 2: the header has no line FIELDS");
  expect_error(header("FIELDS x y z\n"), "neither WIDTH nor POINTS");
  expect_error(header("FIELDS x y z\nFIELDS x\n"), "line 2: the header has two lines FIELDS");
  expect_error(header("FIELDS x y z\nSIZE 4 4\n"), "line 2: SIZE has no value for field 'z'");
  expect_error(header("FIELDS x y z\nSIZE 4 4 4 4\n"), "SIZE has more values than FIELDS");
  expect_error(header("FIELDS x y z\nSIZE 4 4 9\n"), "SIZE '9' is not a whole number from 1 to 8");
  expect_error(header("FIELDS x y z\nTYPE F F D\n"), "type 'D' is not F, I or U");
  expect_error(header("FIELDS x y z\nCOUNT 1 1 -1\n"), "COUNT '-1' is not a whole number from 0");
  expect_error(header("FIELDS x y z\nSIZE 4 4 2\nPOINTS 1\n"), "'z' has type F with 2 bytes");
  expect_error(header("FIELDS x y w\nPOINTS 1\n"), "header: has no field 'z'");
  expect_error("FIELDS x y z\nCOUNT 1 1 2\nPOINTS 1\nDATA ascii\n1 2 3 4\n",
               "header: field 'z' has 2 values instead of one");
  expect_error(header("FIELDS x y z\nPOINTS -1\n"), "POINTS '-1' is not a whole number");
  expect_error(header("FIELDS x y z\nWIDTH 2\nHEIGHT 2\nPOINTS 3\n"), "not WIDTH times HEIGHT");
  expect_error(header("FIELDS x y z\nWIDTH 4294967296\nHEIGHT 4294967296\nPOINTS 0\n"),
               "POINTS is not WIDTH times HEIGHT");
  expect_error(header("FIELDS x y z\nPOINTS 9223372036854775807\n"), "the file is too short for");
  expect_error("FIELDS x y z\nPOINTS 1\nDATA gzip\n", "line 3: DATA 'gzip' is not ascii");
  expect_error("FIELDS x y z\nPOINTS 2\nDATA binary\n" + std::string(23, ' '),
               "the file is too short for 2 points");
  std::string fields = "FIELDS";
  for (int i = 0; i < 1001; ++i) fields += " f";
  expect_error(header(fields + "\n"), "more than 1000 fields");
}

TEST_F(PcdPointsTest, BadPointsAreRefusedWithTheirPlace) {
  const auto text = [](const std::string& rows) {
    return "FIELDS x y z\nPOINTS 2\nDATA ascii\n" + rows;
  };
  expect_error(text("1 2 3\n\n\n\n\n\n\n"), "the file ends after 1 of 2 points");
  expect_error(text("1 2 3\n4 5\n      "), "line 5: the point has 2 of 3 values");
  expect_error(text("1 2 3\n4 5 six\n"), "line 5: coordinate 'six' is not a number");
  expect_error(text("1 2 3 4\n5 6 7\n"), "line 4: the point has '4' after its last value");
}

/// Returns a compressed file of two points with these sizes and data.
std::string compressed_pcd(std::uint32_t packed, std::uint32_t unpacked, const std::string& data) {
  std::string bytes = "FIELDS x y z\nPOINTS 2\nDATA binary_compressed\n";
  append(bytes, packed);
  append(bytes, unpacked);
  return bytes + data;
}

TEST_F(PcdPointsTest, BadCompressedDataIsRefusedWithItsPlace) {
  const std::string head = compressed_pcd(0, 0, "");
  const std::string at_data = "byte " + std::to_string(head.size()) + ": ";
  expect_error(head.substr(0, head.size() - 1), "the file ends before its compressed data");
  expect_error(compressed_pcd(5, 24, "1234"), "the file ends inside its compressed data");
  expect_error(compressed_pcd(4, 25, "1234"), "25 bytes are not 2 points of 12 bytes");
  expect_error(compressed_pcd(0, 24, ""), "0 compressed bytes cannot hold 24 bytes");
  expect_error(compressed_pcd(4, 24,
                              "\x03"
                              "abc"),
               at_data + "the compressed data ends inside");
  expect_error(compressed_pcd(4, 24,
                              {"\x02"
                               "abc",
                               4}),
               "ends before the last point");
  expect_error(compressed_pcd(2, 24, {"\x20\x00", 2}), at_data + "the compressed data copies 1 b");
  expect_error(compressed_pcd(3, 24,
                              {"\x00"
                               "a\xE0",
                               3}),
               "the compressed data ends inside");
  // One zero, repeated: the least data of 24 bytes.
  EXPECT_EQ(read(compressed_pcd(5, 24, {"\x00\x00\xE0\x0E\x00", 5})).places,
            (std::vector<Vec3d>{{}, {}}));
  // A count that the bytes cannot hold, with sizes that agree.
  std::string bytes = "FIELDS x y z\nPOINTS 357913941\nDATA binary_compressed\n";
  append(bytes, std::uint32_t{40'000'000});
  append(bytes, std::uint32_t{4'294'967'292});
  expect_error(bytes, "the file ends inside its compressed data");
}

TEST_F(PcdPointsTest, FieldsAreChannels) {
  const std::vector<Field> fields{{"x", 'F', 4},    {"y", 'F', 4},     {"z", 'F', 8},
                                  {"rgb", 'U', 4},  {"heat", 'F', 8},  {"ring", 'U', 2},
                                  {"side", 'I', 1}, {"label", 'I', 4}, {"vector", 'F', 4, 3}};
  const auto value = [](std::size_t i, const std::string& name, int) {
    const auto n = static_cast<double>(i);
    if (name == "ring") return 60000 + n;
    if (name == "side") return -n;
    if (name == "label") return 70000 - n;
    return name == "heat" ? n / 4 - 3 : n;
  };
  constexpr std::size_t kPoints = 100;
  const std::vector<ChannelRequest> wanted{{"ring", {}}, {"Heat", "t"}, {"side", {}}, {"x", {}}};
  for (const char* const kind : kKinds)
    for (const bool has_labels : {false, true}) {
      write_text(path_, pcd_of({fields, kind}, kPoints, value));
      const auto source = open_voxel_source(
          path_, {.labels = has_labels ? LabelRequest("") : LabelRequest(), .channels = wanted});
      const std::vector<ChannelSpec> specs = source->channels();
      ASSERT_EQ(specs.size(), 4u);
      EXPECT_EQ(specs[0].name, "ring");
      EXPECT_EQ(specs[0].kind, ChannelKind::kU16);
      EXPECT_EQ(specs[1].name, "t");
      EXPECT_EQ(specs[1].kind, ChannelKind::kF32);
      EXPECT_EQ(specs[2].kind, ChannelKind::kI16);
      std::size_t at = 0;
      source->visit_all([&](const VoxelBatch& batch) {
        ASSERT_EQ(batch.channels.size(), 4 * batch.places.size());
        for (std::size_t i = 0; i < batch.places.size(); ++i, ++at) {
          EXPECT_EQ(batch.places[i].z, static_cast<double>(at));
          EXPECT_EQ(batch.colors[i][2], at);
          EXPECT_EQ(batch.channels[4 * i], value(at, "ring", 0));
          EXPECT_EQ(batch.channels[4 * i + 1], value(at, "heat", 0));
          EXPECT_EQ(batch.channels[4 * i + 2], value(at, "side", 0));
          EXPECT_EQ(batch.channels[4 * i + 3], static_cast<double>(at));
          const double label = has_labels ? static_cast<double>(batch.labels[i]) : 0;
          EXPECT_EQ(label, has_labels ? value(at, "label", 0) : 0);
        }
      });
      EXPECT_EQ(at, kPoints);
      const auto error = [&](const std::string& field) {
        return error_of([&] { open_voxel_source(path_, {.channels = {{field, {}}}}); });
      };
      EXPECT_NE(error("cold").find("has no field 'cold'; its fields are x, y, z, rgb, heat"),
                std::string::npos);
      EXPECT_NE(error("vector").find("has 3 values, and a channel has one number"),
                std::string::npos);
    }
}

}  // namespace
}  // namespace voxdag
