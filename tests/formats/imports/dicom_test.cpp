// Series of DICOM, against values compared one by one.
#if VOXDAG_HAS_DICOM
#include <algorithm>
#include <functional>

#include "random_volume.hpp"

namespace voxdag {
namespace {

/// What a test writes into an image.
struct DicomImage {
  std::string position = "0\\0\\0", orientation = "1\\0\\0\\0\\1\\0", spacing = "1\\1",
              modality = "MR", series = "1.2.3", slope = "1", intercept = "0", thickness = {};
  int frames = 0;
};

/// Appends an element of explicit type, little-endian.
void element(std::string& file, std::uint32_t group, std::uint32_t number, const std::string& type,
             std::string value) {
  if (value.size() % 2 != 0) value += type == "UI" || type == "OW" ? '\0' : ' ';
  append(file, group, 2);
  append(file, number, 2);
  file += type;
  if (type == "OW" || type == "OB") append(file, 0, 2);
  append(file, value.size(), type == "OW" || type == "OB" ? 4 : 2);
  file += value;
}

std::string u16(std::uint64_t value) {
  std::string text;
  append(text, value, 2);
  return text;
}

template <class T>
std::string dicom(const DicomImage& image, int columns, int rows, const std::string& values) {
  std::string meta;
  element(meta, 2, 2, "UI", "1.2.840.10008.5.1.4.1.1.7");  // secondary capture
  element(meta, 2, 3, "UI", "1.2.3.4");
  element(meta, 2, 16, "UI", "1.2.840.10008.1.2.1");
  std::string length;
  append(length, meta.size(), 4);
  std::string file(128, '\0');
  file += "DICM";
  element(file, 2, 0, "UL", length);
  file += meta;
  element(file, 8, 0x16, "UI",
          image.modality == "CT" ? "1.2.840.10008.5.1.4.1.1.2" : "1.2.840.10008.5.1.4.1.1.4");
  element(file, 8, 0x18, "UI", "1.2.3.4");
  element(file, 8, 0x60, "CS", image.modality);
  if (!image.thickness.empty()) element(file, 0x18, 0x88, "DS", image.thickness);
  element(file, 0x20, 0xe, "UI", image.series);
  if (!image.position.empty()) element(file, 0x20, 0x32, "DS", image.position);
  element(file, 0x20, 0x37, "DS", image.orientation);
  element(file, 0x28, 2, "US", u16(1));
  element(file, 0x28, 4, "CS", "MONOCHROME2");
  if (image.frames > 0) element(file, 0x28, 8, "IS", std::to_string(image.frames));
  element(file, 0x28, 0x10, "US", u16(static_cast<std::uint64_t>(rows)));
  element(file, 0x28, 0x11, "US", u16(static_cast<std::uint64_t>(columns)));
  element(file, 0x28, 0x30, "DS", image.spacing);
  element(file, 0x28, 0x100, "US", u16(8 * sizeof(T)));
  element(file, 0x28, 0x101, "US", u16(8 * sizeof(T)));
  element(file, 0x28, 0x102, "US", u16(8 * sizeof(T) - 1));
  element(file, 0x28, 0x103, "US", u16(std::is_signed_v<T> ? 1 : 0));
  element(file, 0x28, 0x1052, "DS", image.intercept);
  element(file, 0x28, 0x1053, "DS", image.slope);
  element(file, 0x7fe0, 0x10, "OW", values);
  return file;
}

class Dicom : public VolumeTest {
 protected:
  Dicom() { std::filesystem::create_directory(path("scan")); }

  /// Writes slices under names that do not follow their order.
  template <class T>
  void write_series(const RandomVolume<T>& volume, const DicomImage& image = {},
                    const std::function<std::string(int)>& position = nullptr) const {
    const std::size_t slice = static_cast<std::size_t>(volume.size.x * volume.size.y) * sizeof(T);
    for (int z = 0; z < volume.size.z; ++z) {
      DicomImage at = image;
      at.position = position ? position(z) : "0\\0\\" + std::to_string(z);
      write("scan/IM" + std::to_string((z * 7 + 3) % volume.size.z),
            dicom<T>(at, volume.size.x, volume.size.y,
                     volume.bytes().substr(static_cast<std::size_t>(z) * slice, slice)));
    }
  }
};

TEST_F(Dicom, ASeriesIsSortedByItsPlaces) {
  const RandomVolume<std::uint16_t> words({4, 3, 5}, 1);
  write_series(words);
  EXPECT_EQ(read("scan").voxels, words.voxels_not_0());
  EXPECT_EQ(read("scan", 2.0).voxels, words.voxels([](auto v) { return v >= 2; }));
  const RandomVolume<std::int16_t> signed_words({4, 3, 5}, 2);
  write_series(signed_words);
  EXPECT_EQ(read("scan").voxels, signed_words.voxels_not_0());
  const RandomVolume<std::uint8_t> bytes({4, 4, 5}, 3);
  write_series(bytes);
  EXPECT_EQ(read("scan").voxels, bytes.voxels_not_0());
}

TEST_F(Dicom, ValuesAreScaledFileByFile) {
  const RandomVolume<std::uint16_t> volume({4, 3, 5}, 1);
  write_series(volume, {.modality = "CT", .slope = "2", .intercept = "-1024"});
  EXPECT_TRUE(has(error_of([&] { open("scan"); }), "Hounsfield"));
  EXPECT_EQ(read("scan", -1020.0).voxels, volume.voxels([](auto v) { return v >= 2; }));
  // One file with another scale: no value of it reaches the threshold.
  const std::string values(24, '\1');
  write("scan/IM6",
        dicom<std::uint16_t>(
            {.position = "0\\0\\5", .modality = "CT", .slope = "0.001", .intercept = "-2000"}, 4, 3,
            values));
  EXPECT_EQ(read("scan", -1020.0).voxels, volume.voxels([](auto v) { return v >= 2; }));
}

TEST_F(Dicom, ValuesOfAFolderAreAChannelAndLabels) {
  const RandomVolume<std::int16_t> volume({4, 3, 5}, 1);
  const std::vector<Vec3i> set = volume.voxels_not_0();
  write_series(volume);
  const ChannelRequest value{"value", {}};
  EXPECT_EQ(read_with("scan", {.channels = {value}}).channels, volume.values_at<double>(set));
  const auto kind = [&] {
    return open_voxel_source(path("scan"), {.channels = {value}})->channels()[0].kind;
  };
  EXPECT_EQ(kind(), ChannelKind::kI16);
  EXPECT_EQ(read_with("scan", {.labels = ""}).labels, volume.values_at<Label>(set));
  write_series(volume, {.slope = "0.5", .intercept = "10"});
  const SourceVoxels scaled = read_with("scan", {.channels = {value}});
  EXPECT_EQ(kind(), ChannelKind::kF32);
  ASSERT_EQ(scaled.voxels.size(), volume.values.size());
  for (std::size_t i = 0; i < scaled.voxels.size(); ++i)
    EXPECT_EQ(scaled.channels[i], 0.5 * volume.at(scaled.voxels[i]) + 10);
  EXPECT_TRUE(has(error_of([&] {
                    read_with("scan", {.channels = {{"density", {}}}});
                  }),
                  "the numbers of a volume are called 'value'"));
}

TEST_F(Dicom, PlacesAndSpacingAreThoseOfTheFiles) {
  const RandomVolume<std::uint8_t> volume({2, 2, 3}, 1);
  write_series(volume, {.spacing = "0.5\\0.5"},
               [](int z) { return "10\\20\\" + std::to_string(30 + 0.5 * z); });
  const std::optional<Grid> grid = open("scan")->grid();
  ASSERT_TRUE(grid);
  EXPECT_DOUBLE_EQ(grid->voxel_size, 0.5);
  EXPECT_DOUBLE_EQ(grid->origin.x, 9.75);
  EXPECT_DOUBLE_EQ(grid->origin.y, 19.75);
  EXPECT_DOUBLE_EQ(grid->origin.z, 29.75);
  // The first number of the spacing is the distance of rows: voxels twice as high as wide.
  write_series(volume, {.spacing = "1\\0.5"},
               [](int z) { return "0\\0\\" + std::to_string(0.5 * z); });
  std::vector<Vec3i> expected;
  for (const Vec3i v : volume.voxels_not_0())
    for (int y = 0; y < 2; ++y) expected.push_back({v.x, 2 * v.y + y, v.z});
  std::vector<Vec3i> found = read("scan").voxels;
  const auto order = [](Vec3i a, Vec3i b) {
    return std::tie(a.z, a.y, a.x) < std::tie(b.z, b.y, b.x);
  };
  std::sort(expected.begin(), expected.end(), order);
  std::sort(found.begin(), found.end(), order);
  EXPECT_EQ(found, expected);
}

TEST_F(Dicom, OneFileWithFramesIsAVolume) {
  const RandomVolume<std::uint8_t> volume({4, 2, 3}, 1);
  write("v.dcm", dicom<std::uint8_t>({.thickness = "1", .frames = 3}, 4, 2, volume.bytes()));
  EXPECT_EQ(read("v.dcm").voxels, volume.voxels_not_0());
}

TEST_F(Dicom, WhatIsNoVolumeIsRefused) {
  const RandomVolume<std::uint8_t> volume({4, 2, 5}, 1);
  const auto error = [&] { return error_of([&] { open("scan"); }); };
  write_series(volume, {}, [](int z) { return "0\\0\\" + std::to_string(z == 4 ? 5 : z); });
  EXPECT_TRUE(has(error(), "not evenly spaced")) << error();
  EXPECT_TRUE(has(error(), "are some missing?")) << error();
  write_series(volume, {}, [](int z) { return "0\\0\\" + std::to_string(z / 2 * 2); });
  EXPECT_TRUE(has(error(), "two images at one place")) << error();
  write_series(volume);
  write("scan/other",
        dicom<std::uint8_t>({.position = "0\\0\\9", .series = "1.9"}, 4, 2, std::string(8, 'x')));
  EXPECT_TRUE(has(error(), "of another series")) << error();
  write("scan/other", dicom<std::uint8_t>({.position = "0\\0\\5"}, 2, 4, std::string(8, 'x')));
  EXPECT_TRUE(has(error(), "not the same size")) << error();
  std::filesystem::remove(path("scan/other"));
  write("scan/notes.txt", "no image");
  EXPECT_EQ(read("scan").voxels, volume.voxels_not_0());
  const std::string good = dicom<std::uint8_t>({}, 4, 2, std::string(8, 'x'));
  for (std::size_t size = 0; size < good.size(); ++size) {
    const std::string text = error_of_bytes("v.dcm", good.substr(0, size));
    EXPECT_NE(text, "no error") << size;
  }
}

}  // namespace
}  // namespace voxdag
#endif
