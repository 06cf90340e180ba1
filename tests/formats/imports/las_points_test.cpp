// LAS files of every version and point format, against the points that were written.
#include "point_checks.hpp"

namespace voxdag {
namespace {

class LasPointsTest : public PointFile {
 protected:
  LasPointsTest() : PointFile(".las") {}
};

constexpr int kRecordBytes[] = {20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67};
constexpr int kColorOffset[] = {0, 0, 20, 28, 0, 28, 0, 30, 30, 0, 30};
constexpr Vec3d kScale{0.125, 0.0625, 0.5}, kOffset{1'000'000, -3, 0.25};

struct LasFile {
  int minor = 2;
  int format = 2;
  int extra_bytes = 0;          ///< Behind each record.
  int color_factor = 256;       ///< Of the 8 bits of a colour.
  std::size_t skipped = 60;     ///< Bytes of records between the header and the points.
  std::vector<Vec3i> points{};  ///< The integers.
  std::vector<Rgb8> colors{};
  std::vector<std::uint8_t> flags{};  ///< Byte 15 of each record.
};

template <class T>
void put(std::string& bytes, std::size_t at, T value) {
  std::memcpy(bytes.data() + at, &value, sizeof value);
}

std::size_t header_bytes(int minor) {
  constexpr std::size_t kBytes[] = {227, 227, 227, 235, 375, 393};
  return kBytes[minor];
}

std::string las_of(const LasFile& las) {
  const auto format = static_cast<std::size_t>(las.format);
  const std::size_t header = header_bytes(las.minor),
                    record_bytes = static_cast<std::size_t>(kRecordBytes[format] + las.extra_bytes);
  std::string bytes(header + las.skipped, '\x5A');
  std::fill_n(bytes.begin(), header, '\0');
  bytes.replace(0, 4, "LASF");
  put(bytes, 24, std::uint8_t{1});
  put(bytes, 25, static_cast<std::uint8_t>(las.minor));
  put(bytes, 94, static_cast<std::uint16_t>(header));
  put(bytes, 96, static_cast<std::uint32_t>(header + las.skipped));
  put(bytes, 104, static_cast<std::uint8_t>(las.format));
  put(bytes, 105, static_cast<std::uint16_t>(record_bytes));
  const std::size_t count = las.points.size();
  if (las.format < 6) put(bytes, 107, static_cast<std::uint32_t>(count));
  if (las.minor >= 4) put(bytes, 247, static_cast<std::uint64_t>(count));
  for (int axis = 0; axis < 3; ++axis) {
    put(bytes, 131 + 8 * static_cast<std::size_t>(axis), kScale[axis]);
    put(bytes, 155 + 8 * static_cast<std::size_t>(axis), kOffset[axis]);
  }
  for (std::size_t i = 0; i < count; ++i) {
    std::string record(record_bytes, '\x77');
    for (int axis = 0; axis < 3; ++axis)
      put(record, 4 * static_cast<std::size_t>(axis), las.points[i][axis]);
    put(record, 15, i < las.flags.size() ? las.flags[i] : std::uint8_t{0});
    if (kColorOffset[format] > 0)
      for (std::size_t c = 0; c < 3; ++c)
        put(record, static_cast<std::size_t>(kColorOffset[format]) + 2 * c,
            static_cast<std::uint16_t>(las.colors[i][c] * las.color_factor));
    bytes += record;
  }
  return bytes;
}

LasFile random_las(int minor, int format, int count, unsigned seed) {
  std::mt19937 rng(seed);
  LasFile las;
  las.minor = minor;
  las.format = format;
  las.colors = random_cloud(count, seed).colors;
  for (int i = 0; i < count; ++i)
    las.points.push_back({static_cast<std::int32_t>(rng() % 2000) - 1000,
                          static_cast<std::int32_t>(rng() % 300) - 2'000'000,
                          static_cast<std::int32_t>(rng() % 100)});
  return las;
}

PointCloud cloud_of(const LasFile& las) {
  PointCloud cloud;
  for (const Vec3i p : las.points)
    cloud.places.push_back(
        {p.x * kScale.x + kOffset.x, p.y * kScale.y + kOffset.y, p.z * kScale.z + kOffset.z});
  if (kColorOffset[las.format] > 0) cloud.colors = las.colors;
  return cloud;
}

TEST_F(LasPointsTest, EveryVersionAndFormatIsRead) {
  for (int minor = 0; minor <= 5; ++minor)
    for (int format = 0; format <= (minor >= 4 ? 10 : 5); ++format) {
      LasFile las = random_las(minor, format, 700, static_cast<unsigned>(100 * minor + format));
      las.extra_bytes = format % 3;
      EXPECT_EQ(read(las_of(las)), cloud_of(las)) << minor << " " << format;
      las.skipped = 0;
      EXPECT_EQ(read(las_of(las) + "records behind the points"), cloud_of(las));
      expect_voxels(las_of(las), cloud_of(las).places);
    }
}

TEST_F(LasPointsTest, CoordinatesReachTheEndsOfTheirRange) {
  LasFile las;
  las.format = 0;
  las.points = {{INT32_MIN, INT32_MAX, 0}, {INT32_MAX, INT32_MIN, -1}};
  EXPECT_EQ(read(las_of(las)), cloud_of(las));
}

TEST_F(LasPointsTest, ColoursOfEightBitsAreFoundPerFile) {
  LasFile las = random_las(4, 7, 5'000, 1);
  for (const int factor : {1, 256, 257}) {
    las.color_factor = factor;
    EXPECT_EQ(read(las_of(las)), cloud_of(las)) << factor;
  }
  // One wide component makes all of them wide.
  las.points = {{0, 0, 0}, {1, 1, 1}};
  las.colors = {{255, 255, 0}, {0, 0, 0}};
  las.color_factor = 1;
  std::string bytes = las_of(las);
  put(bytes, bytes.size() - 2, std::uint16_t{256});
  EXPECT_EQ(read(bytes).colors, (std::vector<Rgb8>{{0, 0, 0}, {0, 0, 1}}));
}

TEST_F(LasPointsTest, WithheldPointsAreSkipped) {
  for (const auto& [minor, format, withheld] :
       {std::array{1, 0, 128}, std::array{2, 3, 128}, std::array{4, 6, 4}, std::array{4, 8, 4}}) {
    LasFile las = random_las(minor, format, 256, 3);
    PointCloud kept;
    const PointCloud all = cloud_of(las);
    for (std::size_t i = 0; i < 256; ++i) {
      las.flags.push_back(static_cast<std::uint8_t>(i));
      if ((i & static_cast<std::size_t>(withheld)) != 0) continue;
      kept.places.push_back(all.places[i]);
      if (!all.colors.empty()) kept.colors.push_back(all.colors[i]);
    }
    EXPECT_EQ(read(las_of(las)), kept) << format;
  }
  // In version 1.0 the bits belong to the classification.
  LasFile las = random_las(0, 1, 2, 3);
  las.flags = {128, 255};
  EXPECT_EQ(read(las_of(las)), cloud_of(las));
}

TEST_F(LasPointsTest, LabelsAreTheClassification) {
  for (const auto& [minor, format] : {std::pair{0, 1}, {2, 3}, {4, 7}}) {
    LasFile las = random_las(minor, format, 4, 3);
    las.flags = {2, 5, 0x25, 31};
    std::string bytes = las_of(las);
    const std::size_t first = header_bytes(minor) + las.skipped;
    // Format 7 has its classes in byte 16; byte 15 has flags.
    if (format == 7)
      for (std::size_t i = 0; i < 4; ++i) {
        bytes[first + i * kRecordBytes[7] + 16] = static_cast<char>(i == 3 ? 200 : las.flags[i]);
        bytes[first + i * kRecordBytes[7] + 15] = 0;
      }
    const LabelledPoints points = read_labels(bytes, "");
    // The upper three bits are flags in formats 0 to 5, but in version 1.0.
    const Label third = format == 3 ? 5 : 0x25;
    EXPECT_EQ(points.labels, (std::vector<Label>{2, 5, third, format == 7 ? 200 : 31}));
    EXPECT_EQ(points.names.at(2), "ground");
    EXPECT_EQ(points.names.size(), format == 7 ? 23u : 13u);
    EXPECT_EQ(read_labels(bytes, "point_source_id").labels, std::vector<Label>(4, 0x7777));
  }
}

TEST_F(LasPointsTest, TheLegacyCountWinsWithAWarning) {
  const LasFile las = random_las(4, 1, 3, 5);
  const std::string good = las_of(las);
  write_text(path_, good);
  EXPECT_TRUE(open_voxel_source(path_)->warnings().empty());
  std::string bytes = good;
  put(bytes, 107, std::uint32_t{2});
  EXPECT_EQ(read(bytes).places.size(), 2u);
  const auto warnings = open_voxel_source(path_)->warnings();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("the legacy one, 2, is used"), std::string::npos);
  bytes = good;
  put(bytes, 247, std::uint64_t{0});
  EXPECT_EQ(read(bytes).places.size(), 3u);
  EXPECT_TRUE(open_voxel_source(path_)->warnings().empty());
}

TEST_F(LasPointsTest, FormatsFrom6OnHaveTheLongCountOnly) {
  const LasFile las = random_las(4, 7, 3, 5);
  for (const std::uint32_t legacy : {0u, 1u, 4'294'967'295u}) {
    std::string bytes = las_of(las);
    put(bytes, 107, legacy);
    EXPECT_EQ(read(bytes), cloud_of(las));
    EXPECT_TRUE(open_voxel_source(path_)->warnings().empty());
  }
  // A writer that fills the legacy count only.
  std::string bytes = las_of(las);
  put(bytes, 107, std::uint32_t{3});
  put(bytes, 247, std::uint64_t{0});
  EXPECT_EQ(read(bytes), cloud_of(las));
}

TEST_F(LasPointsTest, HeadersOf1Point3MayEndEarly) {
  const LasFile las = random_las(3, 2, 3, 5);
  std::string bytes = las_of(las);
  bytes.erase(227, 8);
  put(bytes, 94, std::uint16_t{227});
  put(bytes, 96, static_cast<std::uint32_t>(227 + las.skipped));
  EXPECT_EQ(read(bytes), cloud_of(las));
}

TEST_F(LasPointsTest, PointsOfALatticeSetAVoxelEach) {
  LasFile las;
  las.format = 0;
  for (int i = 0; i < 64; ++i) las.points.push_back({1'000 + 50 * i, -7 * 50, 4'649'776});
  std::string bytes = las_of(las);
  for (int axis = 0; axis < 3; ++axis) {
    put(bytes, 131 + 8 * static_cast<std::size_t>(axis), 0.001);
    put(bytes, 155 + 8 * static_cast<std::size_t>(axis), axis == 0 ? 500'000.0 : 0.1);
  }
  write_text(path_, bytes);
  ImportOptions options;
  options.voxel_size = 0.05;
  options.folder = dir_.path();
  std::vector<Vec3i> line;
  for (int i = 0; i < 64; ++i) line.push_back({i, 0, 0});
  EXPECT_EQ(import_voxels(*open_voxel_source(path_), options).dag, brute_svdag(6, line));
  // The same points on planes of a grid that is given.
  options.bounds = Box3d{{500'001, -0.25, 4'649.876}, {500'004.2, 2, 4'650}};
  EXPECT_EQ(import_voxels(*open_voxel_source(path_), options).dag, brute_svdag(6, line));
}

TEST_F(LasPointsTest, CompressedFilesAreRefusedByName) {
  std::string bytes = las_of(random_las(2, 3, 3, 1));
  put(bytes, 104, std::uint8_t{3 + 128});
  expect_error(bytes, "byte 104: is a compressed LAS file (LAZ)");
  write_text(dir_ / "a.laz", las_of({}));
  EXPECT_TRUE(open_voxel_source(dir_ / "a.laz")->has_points());
  const auto laz = dir_ / "cloud.LAZ";
  write_text(laz, bytes);
  EXPECT_NE(error_of([&] { open_voxel_source(laz); }).find("decompress it with laszip or PDAL"),
            std::string::npos);
}

TEST_F(LasPointsTest, DamagedFilesAreRefusedOrSafe) {
  for (const auto& [minor, format] : {std::array{0, 0}, std::array{2, 2}, std::array{4, 7}}) {
    const std::string good = las_of(random_las(minor, format, 3, 2));
    expect_damage_is_safe(good, good.size());
  }
}

TEST_F(LasPointsTest, BadHeadersAreRefusedWithTheirPlace) {
  const std::string good = las_of(random_las(4, 7, 3, 2));
  const auto expect = [&](std::size_t at, auto value, const std::string& part) {
    std::string bytes = good;
    put(bytes, at, value);
    expect_error(bytes, part);
  };
  expect_error("", "byte 0: is not a LAS file");
  expect_error("LASF", "byte 4: the file ends inside its header");
  expect(24, std::uint8_t{2}, "byte 24: LAS version 2.4 is not 1.0 to 1.5");
  expect(25, std::uint8_t{6}, "LAS version 1.6");
  expect(94, std::uint16_t{374}, "byte 94: a header of 374 bytes is too short for version 1.4");
  expect(96, std::uint32_t{374}, "byte 96: the point records start inside the header");
  expect(96, std::uint32_t{4'000'000'000}, "byte 96: the point records start beyond the end");
  expect(104, std::uint8_t{11}, "byte 104: point format 11 is not 0 to 10");
  expect(105, std::uint16_t{35}, "byte 105: point records of 35 bytes are too short for format 7");
  std::string legacy = las_of(random_las(2, 2, 3, 2));
  put(legacy, 107, std::uint32_t{4'294'967'295});
  expect_error(legacy, "byte 107: the file ends after 3 of 4294967295 points");
  expect(247, std::uint64_t{4}, "byte 247: the file ends after 3 of 4 points");
  expect(247, UINT64_MAX, "byte 247: the file ends after 3 of 18446744073709551615 points");
  expect(131, 0.0, "byte 131: scale and offset do not give finite coordinates");
  expect(139, std::nan(""), "byte 139: scale and offset");
  expect(147, 1e300, "byte 147: scale and offset");
  expect(171, HUGE_VAL, "byte 147: scale and offset");
}

}  // namespace
}  // namespace voxdag
