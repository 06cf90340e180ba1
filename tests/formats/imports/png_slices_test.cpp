// Folders of PNG files against pixels compared one by one.
#include <png.h>

#include "random_volume.hpp"
#include "support/brute_svdag.hpp"
#include "voxdag/formats/imports/volumes/volume_sources.hpp"

namespace voxdag {
namespace {

/// Returns a PNG of samples in rows from top to bottom; those of 16 bits are big-endian.
std::string png_of(int width, int height, int color_type, int bits, const std::string& samples) {
  std::string out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &out,
      [](png_structp p, png_bytep bytes, png_size_t size) {
        static_cast<std::string*>(png_get_io_ptr(p))
            ->append(reinterpret_cast<const char*>(bytes), size);
      },
      nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bits,
               color_type, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  const std::size_t row = samples.size() / static_cast<std::size_t>(height);
  for (std::size_t y = 0; y < samples.size(); y += row)
    png_write_row(png, reinterpret_cast<png_const_bytep>(samples.data() + y));
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  return out;
}

class PngSlicesTest : public VolumeTest {
 protected:
  void new_folder() {
    std::filesystem::remove_all(path("s"));
    std::filesystem::create_directory(path("s"));
  }
  void add(const std::string& name, const std::string& png) { write("s/" + name, png); }
};

TEST_F(PngSlicesTest, GreyValuesAreComparedWithTheThreshold) {
  const RandomVolume<std::uint8_t> bytes({5, 3, 12}, 3);
  const RandomVolume<std::uint16_t> words({5, 3, 12}, 4);
  const auto check = [&](const auto& volume, int bits) {
    new_folder();
    const std::string data = volume.bytes(true);
    const std::size_t slice = data.size() / 12;
    for (std::size_t z = 0; z < 12; ++z)
      add("slice " + std::to_string(z) + (z % 2 == 0 ? ".png" : ".PNG"),
          png_of(5, 3, PNG_COLOR_TYPE_GRAY, bits, data.substr(z * slice, slice)));
    add("notes.txt", "not a slice");
    add(".slice 3.png", "not a slice");
    EXPECT_FALSE(open("s")->has_colors());
    EXPECT_EQ(read("s").voxels, volume.voxels_not_0());
    EXPECT_EQ(import("s").dag, brute_svdag(4, volume.voxels_not_0()));
    EXPECT_EQ(read("s", 2.5).voxels, volume.voxels([](auto v) { return v >= 2.5; }));
  };
  check(bytes, 8);
  check(words, 16);
}

TEST_F(PngSlicesTest, GreyValuesAreLabelsAndAChannel) {
  const RandomVolume<std::uint8_t> bytes({5, 3, 12}, 3);
  const RandomVolume<std::uint16_t> words({5, 3, 12}, 4);
  const ChannelRequest value{"value", "density"};
  const auto check = [&](const auto& volume, int bits, ChannelKind kind) {
    new_folder();
    const std::string data = volume.bytes(true);
    const std::size_t slice = data.size() / 12;
    for (std::size_t z = 0; z < 12; ++z)
      add("slice " + std::to_string(z) + ".png",
          png_of(5, 3, PNG_COLOR_TYPE_GRAY, bits, data.substr(z * slice, slice)));
    const std::vector<Vec3i> set = volume.voxels_not_0(),
                             high = volume.voxels([](auto v) { return v >= 3; });
    const SourceVoxels both = read_with("s", {.labels = "", .channels = {value}});
    EXPECT_EQ(both.voxels, set);
    EXPECT_EQ(both.labels, volume.template values_at<Label>(set));
    EXPECT_EQ(both.channels, volume.template values_at<double>(set));
    EXPECT_EQ(read_with("s", {.threshold = 3, .labels = ""}).labels,
              volume.template values_at<Label>(high));
    const auto source = open_voxel_source(path("s"), {.channels = {value}});
    ASSERT_EQ(source->channels().size(), 1u);
    EXPECT_EQ(source->channels()[0].kind, kind);
    EXPECT_EQ(source->channels()[0].name, "density");
  };
  check(bytes, 8, ChannelKind::kU8);
  check(words, 16, ChannelKind::kU16);
  const auto error = [&](const VoxelSourceOptions& options) {
    return error_of([&] { read_with("s", options); });
  };
  EXPECT_TRUE(has(error({.labels = "organ"}), "has no fields, of which 'organ'"));
  EXPECT_TRUE(has(error({.channels = {{"grey", {}}}}), "are called 'value'"));
  EXPECT_TRUE(has(error({.channels = {value, value}}), "so one channel"));
  add("slice 7.png", png_of(5, 3, PNG_COLOR_TYPE_GRAY, 4, std::string(9, '\1')));
  EXPECT_TRUE(has(error({.labels = ""}),
                  "slice 7.png: header: has grey values of 4 bits, and labels need 8 or 16"));
  add("slice 7.png", png_of(5, 3, PNG_COLOR_TYPE_RGB, 8, std::string(45, '\1')));
  EXPECT_TRUE(has(error({.labels = ""}), "slice 7.png: header: holds colours, not labels"));
  EXPECT_TRUE(has(error({.channels = {value}}), "holds colours, not channels"));
}

TEST_F(PngSlicesTest, AlphaAndColorsDecide) {
  new_folder();
  add("1.png",
      png_of(2, 2, PNG_COLOR_TYPE_RGBA, 8, std::string("\1\2\3\0\4\5\6\7\0\0\0\1\0\0\0\0", 16)));
  add("2.png", png_of(2, 2, PNG_COLOR_TYPE_RGB, 8, std::string("\0\0\0\0\0\1\1\0\0\0\2\0", 12)));
  add("3.png", png_of(2, 2, PNG_COLOR_TYPE_GRAY_ALPHA, 8, std::string("\5\0\0\1\6\1\1\1", 8)));
  add("4.png", png_of(2, 2, PNG_COLOR_TYPE_RGB, 16,
                      std::string("\0\0\0\0\0\0\1\1\0\0\377\377", 12) + std::string(12, '\0')));
  EXPECT_TRUE(open("s")->has_colors());
  const SourceVoxels all = read("s");
  EXPECT_EQ(
      all.voxels,
      (std::vector<Vec3i>{
          {1, 0, 0}, {0, 1, 0}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}, {0, 1, 2}, {1, 1, 2}, {1, 0, 3}}));
  EXPECT_EQ(all.colors, (std::vector<Rgb8>{{4, 5, 6},
                                           {0, 0, 0},
                                           {0, 0, 1},
                                           {1, 0, 0},
                                           {0, 2, 0},
                                           {6, 6, 6},
                                           {1, 1, 1},
                                           {1, 0, 255}}));
  EXPECT_EQ(read("s", 2.0).voxels,
            (std::vector<Vec3i>{{1, 0, 0}, {1, 1, 1}, {0, 1, 2}, {1, 0, 3}}));
}

TEST_F(PngSlicesTest, AlphaThatIs255EverywhereIsNoValue) {
  new_folder();
  const std::string pixels("\377\377\377\377\0\0\0\377", 8);
  add("1.png", png_of(2, 1, PNG_COLOR_TYPE_RGBA, 8, pixels));
  add("2.png", png_of(2, 1, PNG_COLOR_TYPE_RGBA, 8, pixels));
  EXPECT_EQ(read("s", 128.0).voxels, (std::vector<Vec3i>{{0, 0, 0}, {0, 0, 1}}));
  add("2.png", png_of(2, 1, PNG_COLOR_TYPE_RGBA, 8, std::string("\0\0\0\376\0\0\0\0", 8)));
  EXPECT_EQ(read("s", 128.0).voxels, (std::vector<Vec3i>{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}));
}

TEST_F(PngSlicesTest, MissingSlicesAreWarnedOf) {
  const auto warning = [&](const std::vector<std::string>& names) {
    new_folder();
    for (const std::string& name : names) add(name, png_of(1, 1, PNG_COLOR_TYPE_GRAY, 8, "a"));
    const auto warnings = open("s")->warnings();
    return warnings.empty() ? "none" : warnings[0];
  };
  EXPECT_EQ(warning({"a.png"}), "none");
  EXPECT_EQ(warning({"a.png", "b.png"}), "none");
  EXPECT_EQ(warning({"s1.png", "s2.png", "s3.png"}), "none");
  EXPECT_EQ(warning({"s10.png", "s15.png", "s20.png"}), "none");
  EXPECT_EQ(warning({"2024-v1.png", "2024-v2.png"}), "none");
  EXPECT_TRUE(has(warning({"s1.png", "s3.png"}), "1 slice is missing, the first between 's1.png'"));
  EXPECT_TRUE(has(warning({"s1.png", "s2.png", "s4.png", "s8.png"}), "4 slices are missing"));
}

TEST_F(PngSlicesTest, NamesAreSortedByTheirNumbers) {
  const std::vector<std::string> sorted = {"",
                                           "1",
                                           "01",
                                           "2.png",
                                           "10.png",
                                           "a",
                                           "a1b2",
                                           "a1b10",
                                           "a02b1",
                                           "a99999999999999999999",
                                           "a100000000000000000000",
                                           "b0"};
  for (std::size_t i = 0; i < sorted.size(); ++i)
    for (std::size_t j = 0; j < sorted.size(); ++j)
      if (sorted[i] != "1" || sorted[j] != "01") {
        if (sorted[i] != "01" || sorted[j] != "1") {
          EXPECT_EQ(is_before_by_numbers(sorted[i], sorted[j]), i < j)
              << sorted[i] << " " << sorted[j];
        }
      }
  EXPECT_NE(is_before_by_numbers("1", "01"), is_before_by_numbers("01", "1"));
}

TEST_F(PngSlicesTest, OtherFoldersAreRefused) {
  const auto error = [&] { return error_of([&] { import("s"); }); };
  const std::string grey = png_of(2, 1, PNG_COLOR_TYPE_GRAY, 8, "ab");
  new_folder();
  EXPECT_TRUE(has(error(), "the folder has no .png files"));
  add("1.png", grey);
  EXPECT_EQ(error(), "no error");
  add("2.png", png_of(1, 2, PNG_COLOR_TYPE_GRAY, 8, "ab"));
  EXPECT_TRUE(has(error(), "2.png: header: has 1 x 2 pixels; the first slice has 2 x 1"));
  add("2.png", png_of(2, 1, PNG_COLOR_TYPE_RGB, 8, "abcdef"));
  EXPECT_TRUE(has(error(), "2.png: header: has colours; the first slice is grey"));
  for (std::size_t size = 0; size < grey.size(); ++size) {
    add("2.png", grey.substr(0, size));
    EXPECT_NE(error(), "no error") << size;
  }
}

}  // namespace
}  // namespace voxdag
