// Dense arrays of NumPy, and the threshold of dense volumes, against values compared one by one.
#include <bit>
#include <cmath>
#include <limits>

#include "random_volume.hpp"
#include "support/brute_svdag.hpp"
#include "voxdag/formats/imports/value_type.hpp"
#include "voxdag/formats/imports/volumes/value_test.hpp"

namespace voxdag {
namespace {

std::string npy(const std::string& dtype, bool is_fortran, const std::string& shape,
                const std::string& data) {
  const std::string type = dtype.starts_with('[') ? dtype : "'" + dtype + "'";
  std::string header = "{'descr': " + type +
                       ", 'fortran_order': " + (is_fortran ? "True" : "False") + ", 'shape': (" +
                       shape + "), }";
  header.resize((header.size() + 10 + 64) / 64 * 64 - 11, ' ');
  header += '\n';
  std::string text("\x93NUMPY\x01\x00", 8);
  append(text, std::uint64_t{header.size()}, 2);
  return text + header + data;
}
std::string shape_of(Vec3i size) {
  return std::to_string(size.x) + ", " + std::to_string(size.y) + ", " + std::to_string(size.z);
}

class NpyVolume : public VolumeTest {
 protected:
  template <class T>
  void check_type(const std::string& dtype) {
    unsigned seed = 1;
    for (const Vec3i size : {Vec3i{1, 1, 1}, Vec3i{3, 9, 4}, Vec3i{6, 2, 5}})
      for (const bool is_big_endian : {false, true})
        for (const bool is_fortran : {false, true}) {
          const RandomVolume<T> volume(size, ++seed);
          const char* order = sizeof(T) == 1 ? "|" : is_big_endian ? ">" : "<";
          write("a.npy", npy(order + dtype, is_fortran, shape_of(size),
                             volume.bytes(is_big_endian, !is_fortran)));
          const auto set = volume.voxels_not_0(!is_fortran);
          EXPECT_EQ(read("a.npy").voxels, set) << dtype << order << is_fortran;
          const ImportResult result = import("a.npy");
          EXPECT_EQ(result.grid.levels, size.y == 9 ? 4 : size.x == 6 ? 3 : 2);
          EXPECT_EQ(result.dag, brute_svdag(result.grid.levels, set));
          for (const double threshold : {-1.5, 0.0, 0.25, 1.0, 2.5, 1e300, -1e300})
            EXPECT_EQ(read("a.npy", threshold).voxels,
                      volume.voxels([&](T v) { return static_cast<double>(v) >= threshold; },
                                    !is_fortran))
                << dtype << " " << threshold;
        }
  }
};

TEST_F(NpyVolume, EveryTypeAndOrderIsRead) {
  check_type<std::int8_t>("i1");
  check_type<std::uint8_t>("u1");
  check_type<std::uint8_t>("b1");
  check_type<std::int16_t>("i2");
  check_type<std::uint16_t>("u2");
  check_type<std::int32_t>("i4");
  check_type<std::uint32_t>("u4");
  check_type<std::int64_t>("i8");
  check_type<std::uint64_t>("u8");
  check_type<float>("f4");
  check_type<double>("f8");
}

TEST_F(NpyVolume, VolumesLargerThanABufferAreRead) {
  const RandomVolume<std::int16_t> volume({70, 33, 65}, 3);
  write("a.npy", npy("<i2", false, "70, 33, 65", volume.bytes(false, true)));
  const ImportResult result = import("a.npy");
  EXPECT_EQ(result.grid.levels, 7);
  EXPECT_EQ(result.dag, brute_svdag(7, volume.voxels_not_0()));
}

TEST_F(NpyVolume, ColorsOfFourAxes) {
  const Vec3i size{3, 2, 4};
  for (const int channels : {3, 4})
    for (const bool is_fortran : {false, true})
      for (const std::optional<double> threshold : {std::optional<double>(), {0.0}, {2.0}}) {
        std::mt19937 rng(9);
        std::vector<std::vector<std::uint8_t>> pixels;  // In the order of C.
        for (int i = 0; i < 24; ++i) {
          pixels.emplace_back();
          for (int c = 0; c < channels; ++c)
            pixels.back().push_back(static_cast<std::uint8_t>(rng() % 2 * (rng() % 4)));
        }
        const RandomVolume<std::uint8_t> order(size, 1);
        std::string data;
        SourceVoxels expected;
        const auto pixel = [&](Vec3i v) {
          return pixels[static_cast<std::size_t>((v.x * size.y + v.y) * size.z + v.z)];
        };
        order.for_each(!is_fortran, [&](Vec3i v) {
          const auto p = pixel(v);
          const int value = channels == 4 ? p[3] : std::max({p[0], p[1], p[2]});
          if (threshold ? value >= *threshold : value != 0) {
            expected.voxels.push_back(v);
            expected.colors.push_back({p[0], p[1], p[2]});
          }
        });
        if (is_fortran)
          for (std::size_t c = 0; c < pixels[0].size(); ++c)
            order.for_each(false, [&](Vec3i v) { data += static_cast<char>(pixel(v)[c]); });
        else
          for (const auto& p : pixels) data.append(p.begin(), p.end());
        write("a.npy", npy("|u1", is_fortran, "3, 2, 4, " + std::to_string(channels), data));
        EXPECT_TRUE(open("a.npy")->has_colors());
        EXPECT_EQ(read("a.npy", threshold).voxels, expected.voxels);
        EXPECT_EQ(read("a.npy", threshold).colors, expected.colors);
      }
}

/// Returns the bits of a number as a real number of 16 bits; it must have one.
std::uint16_t half_of(double value) {
  if (value == 0) return std::signbit(value) ? 0x8000 : 0;
  int exponent = 0;
  const double fraction = std::frexp(std::abs(value), &exponent);  // [0.5, 1)
  const int biased = exponent + 14;
  const double scaled = biased > 0 ? (2 * fraction - 1) * 1024 : std::ldexp(std::abs(value), 24);
  return static_cast<std::uint16_t>((value < 0 ? 0x8000 : 0) | std::max(biased, 0) << 10 |
                                    static_cast<int>(scaled));
}

TEST_F(NpyVolume, RealNumbersOf16BitsAreExact) {
  for (const double value :
       {0.0, -0.0, 1.0, -2.5, 65504.0, 0x1p-14, 0x1p-24, 1023 * 0x1p-24, 1 / 1024.0})
    EXPECT_EQ(static_cast<double>(Half{half_of(value)}), value) << value;
  EXPECT_TRUE(std::isnan(static_cast<float>(Half{0x7E00})));
  EXPECT_EQ(static_cast<float>(Half{0xFC00}), -HUGE_VALF);
  const std::vector<double> values = {0, 0.5, -0.0, 3, std::nan(""), -1, 0x1p-24, 2};
  std::string data;
  for (const double v : values)
    append(data, std::uint64_t{std::isnan(v) ? std::uint16_t{0x7E01} : half_of(v)}, 2);
  write("a.npy", npy("<f2", true, "8, 1, 1", data));
  EXPECT_EQ(read("a.npy").voxels,
            (std::vector<Vec3i>{{1, 0, 0}, {3, 0, 0}, {5, 0, 0}, {6, 0, 0}, {7, 0, 0}}));
  EXPECT_EQ(read("a.npy", 0.5).voxels, (std::vector<Vec3i>{{1, 0, 0}, {3, 0, 0}, {7, 0, 0}}));
}

TEST_F(NpyVolume, AlphaThatIs255EverywhereIsNoValue) {
  const std::string data("\0\0\0\377\1\2\3\377", 8);
  write("a.npy", npy("|u1", false, "1, 1, 2, 4", data));
  EXPECT_EQ(read("a.npy").voxels, (std::vector<Vec3i>{{0, 0, 1}}));
  EXPECT_EQ(read("a.npy", 3.0).voxels, (std::vector<Vec3i>{{0, 0, 1}}));
  EXPECT_TRUE(read("a.npy", 4.0).voxels.empty());
}

/// Returns the bytes of rows of three numbers, by rows or by columns.
template <class T>
std::string rows_of(const std::vector<Vec3i>& voxels, bool is_fortran, bool is_big_endian) {
  std::string text;
  const auto add = [&](int number) {
    const auto value = static_cast<T>(number);
    std::uint64_t bits = 0;
    std::memcpy(&bits, &value, sizeof value);
    append(text, bits, sizeof value, is_big_endian);
  };
  for (int axis = 0; is_fortran && axis < 3; ++axis)
    for (const Vec3i v : voxels) add(v[axis]);
  for (const Vec3i v : voxels)
    for (int axis = 0; !is_fortran && axis < 3; ++axis) add(v[axis]);
  return text;
}

TEST_F(NpyVolume, RowsMayHaveAnyTypeAndOrder) {
  const std::vector<Vec3i> voxels = {{0, 0, 0}, {1, 5, 7}, {100, 2, 3}, {7, 120, 1}};
  const auto check = [&]<class T>(const std::string& dtype, T) {
    for (const bool is_fortran : {false, true})
      for (const bool is_big_endian : {false, true}) {
        const char* order = sizeof(T) == 1 ? "|" : is_big_endian ? ">" : "<";
        write("a.npy", npy(order + dtype, is_fortran, "4, 3",
                           rows_of<T>(voxels, is_fortran, is_big_endian)));
        EXPECT_EQ(read("a.npy").voxels, voxels) << dtype << order << is_fortran;
        EXPECT_EQ(open("a.npy")->has_points(), std::is_floating_point_v<T>);
      }
  };
  check("i1", std::int8_t{});
  check("u1", std::uint8_t{});
  check("i2", std::int16_t{});
  check("u2", std::uint16_t{});
  check("i4", std::int32_t{});
  check("u4", std::uint32_t{});
  check("i8", std::int64_t{});
  check("u8", std::uint64_t{});
  check("f4", float{});
  check("f8", double{});
  write("a.npy",
        npy("<i8", false, "1, 3", rows_of<std::int64_t>({{1, 2, 3}}, false, false) + "more"));
  EXPECT_TRUE(has(open("a.npy")->warnings().at(0), "bytes after the array are left out: 4"));
  // Numbers beyond the largest grid, and below 0.
  const auto far = [&](std::int64_t number) {
    std::string row;
    for (int axis = 0; axis < 3; ++axis) append(row, static_cast<std::uint64_t>(number), 8);
    return error_of_bytes("a.npy", npy("<i8", false, "1, 3", row));
  };
  EXPECT_TRUE(has(far((std::int64_t{1} << 32) + 1), "beyond 1048575"));
  EXPECT_TRUE(has(far(-(std::int64_t{1} << 32)), "beyond 2^31"));
}

TEST_F(NpyVolume, RowsMayHaveNamedFields) {
  std::string data;
  append(data, std::bit_cast<std::uint64_t>(0.5), 8);  // Y
  append(data, std::uint64_t{7}, 1);                   // tag
  append(data, std::uint64_t{std::bit_cast<std::uint32_t>(2.0f)}, 4, true);
  append(data, std::bit_cast<std::uint64_t>(-3.0), 8);
  for (const int c : {65535, 128 * 257, 0}) append(data, static_cast<std::uint64_t>(c), 2);
  write("a.npy", npy("[('Y', '<f8'), ('tag', '|u1'), ('X', '>f4'), ('Z', '<f8'), ('Red', '<u2'), "
                     "('Green', '<u2'), ('Blue', '<u2')]",
                     false, "1,", data));
  EXPECT_TRUE(open("a.npy")->has_points());
  open("a.npy")->visit_all([](const VoxelBatch& batch) {
    EXPECT_EQ(batch.places[0], (Vec3d{2, 0.5, -3}));
    EXPECT_EQ(batch.colors[0], (Rgb8{255, 128, 0}));
  });
  const auto error = [&](const std::string& dtype) {
    return error_of_bytes("a.npy", npy(dtype, false, "1,", std::string(64, '\0')));
  };
  EXPECT_TRUE(has(error("[('x', '<f4'), ('y', '<f4')]"), "is no array of shape (N, 3)"));
  EXPECT_TRUE(has(error("[('x', '<f4'"), "malformed header"));
  EXPECT_TRUE(has(error("[('voxel', '<i4', (3,)), ('more', [('a', '<i4')])]"), "is no array"));
  EXPECT_EQ(error("[('voxel', '<i4', (3,)), ('', '|V20'), ('name', '<U5')]"), "no error");
}

TEST_F(NpyVolume, OtherArraysAreRefused) {
  const auto error = [&](const std::string& dtype, const std::string& shape) {
    return error_of_bytes("a.npy", npy(dtype, false, shape, "12345678"));
  };
  EXPECT_EQ(error("<f2", "1, 2, 2"), "no error");
  EXPECT_TRUE(has(error("<c8", "1, 1, 1"),
                  "must be bools, integers or real numbers of 16, 32 or 64 bits, not '<c8'"));
  EXPECT_TRUE(has(error("|f4", "1, 1, 2"), "not '|f4'"));
  EXPECT_TRUE(has(error("", "1, 1, 2"), "not ''"));
  EXPECT_TRUE(has(error("<f4", "1, 1, 3"), "truncated: the volume needs 12 bytes"));
  EXPECT_EQ(error("<f4", "1, 1, 1"), "no error");
  EXPECT_TRUE(has(open("a.npy")->warnings().at(0), "bytes after the volume are left out: 4"));
  EXPECT_TRUE(has(error("<f4", "0, 1, 1"), "a side of the volume has 0 voxels"));
  EXPECT_TRUE(has(error("|u1", "1048577, 1, 1"), "has 1048577 voxels; 1 to 1048576"));
  EXPECT_TRUE(has(error("<f8", "1048576, 1048576, 1048576"), "more than 2^63 bytes"));
  EXPECT_TRUE(has(error("<f4", "1048576, 1048576, 1048576"), "needs 4611686018427387904 bytes"));
  EXPECT_TRUE(has(error("|u1", "1, 2, 2, 2"), "an array of four axes must be uint8"));
  EXPECT_TRUE(has(error("|i1", "1, 1, 2, 4"), "an array of four axes must be uint8"));
  EXPECT_TRUE(has(error("|u1", "1, 1, 2, 2, 2"), "is no array of shape (N, 3)"));
  EXPECT_TRUE(has(error_of_bytes("a.npy", npy("<i4", false, "1, 3", "123456789012"), 1.0),
                  "has no values to compare with a threshold"));
}

TEST_F(NpyVolume, EveryTruncatedOrDamagedFileIsRefusedOrSafe) {
  const RandomVolume<std::int16_t> volume({3, 2, 4}, 5);
  const std::string good = npy("<i2", false, "3, 2, 4", volume.bytes(false, true));
  expect_no_prefix_is_read("a.npy", good);
  EXPECT_GT(flip_every_bit("a.npy", good), 500);
}

TEST(ValueTest, ThresholdsOfIntegersAreExact) {
  const std::int64_t big = std::int64_t{1} << 53;
  EXPECT_FALSE(IsAtLeast<std::int64_t>(9007199254740994.0)(big + 1));
  EXPECT_TRUE(IsAtLeast<std::int64_t>(9007199254740994.0)(big + 2));
  constexpr std::uint64_t kMax = std::numeric_limits<std::uint64_t>::max();
  EXPECT_FALSE(IsAtLeast<std::uint64_t>(18446744073709551616.0)(kMax));
  EXPECT_TRUE(IsAtLeast<std::uint64_t>(18446744073709549568.0)(kMax));
  EXPECT_TRUE(IsAtLeast<std::int64_t>(-1e300)(std::numeric_limits<std::int64_t>::min()));
  EXPECT_TRUE(IsAtLeast<std::int8_t>(-128)(-128));
  EXPECT_FALSE(IsAtLeast<std::uint8_t>(255.5)(255));
  EXPECT_TRUE(IsAtLeast<std::uint8_t>(254.5)(255));
  EXPECT_FALSE(IsAtLeast<std::uint8_t>(std::nan(""))(255));
  EXPECT_FALSE(IsAtLeast<double>(std::nan(""))(255));
  EXPECT_FALSE(IsAtLeast<double>(-1)(std::nan("")));
  EXPECT_TRUE(IsAtLeast<std::uint8_t>(-HUGE_VAL)(0));
  EXPECT_FALSE(IsAtLeast<std::uint8_t>(HUGE_VAL)(255));
}

}  // namespace
}  // namespace voxdag
