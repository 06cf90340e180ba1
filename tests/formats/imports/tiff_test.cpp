// Stacks of TIFF in every layout, against values compared one by one.
#if VOXDAG_HAS_TIFF
#include <tiffio.h>

#include <algorithm>
#include <functional>
#include <memory>

#include "random_volume.hpp"

namespace voxdag {
namespace {

struct TiffLayout {
  const char* mode = "w";  ///< Of TIFFOpen(): b is big-endian, 8 is BigTIFF.
  int compression = COMPRESSION_NONE;
  bool is_tiled = false;
  std::uint16_t photometric = PHOTOMETRIC_MINISBLACK;
  std::string description = {};
  float pixels_per_unit = 0;
};

class Tiff : public VolumeTest {
 protected:
  using File = std::unique_ptr<TIFF, void (*)(TIFF*)>;

  File create(const std::string& name, const char* mode = "w") const {
    std::filesystem::remove(path(name));
    return {TIFFOpen(path(name).c_str(), mode), TIFFClose};
  }
  template <class T>
  static void set_header(TIFF* tiff, Vec3i size, const TiffLayout& layout,
                         int bits = 8 * sizeof(T)) {
    TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, size.x);
    TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, size.y);
    TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, bits);
    TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
    TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT,
                 std::is_floating_point_v<T> ? SAMPLEFORMAT_IEEEFP
                 : std::is_signed_v<T>       ? SAMPLEFORMAT_INT
                                             : SAMPLEFORMAT_UINT);
    TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, layout.photometric);
    TIFFSetField(tiff, TIFFTAG_COMPRESSION, layout.compression);
    if (layout.is_tiled) {
      TIFFSetField(tiff, TIFFTAG_TILEWIDTH, 16);
      TIFFSetField(tiff, TIFFTAG_TILELENGTH, 16);
    } else {
      TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 2);
    }
    if (!layout.description.empty())
      TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, layout.description.c_str());
    if (layout.pixels_per_unit > 0) {
      TIFFSetField(tiff, TIFFTAG_XRESOLUTION, static_cast<double>(layout.pixels_per_unit));
      TIFFSetField(tiff, TIFFTAG_YRESOLUTION, static_cast<double>(layout.pixels_per_unit));
    }
  }
  template <class T>
  static void write_page(TIFF* tiff, const RandomVolume<T>& volume, int z,
                         const TiffLayout& layout) {
    set_header<T>(tiff, volume.size, layout);
    const Vec3i size = volume.size;
    if (layout.is_tiled) {
      for (int y0 = 0; y0 < size.y; y0 += 16)
        for (int x0 = 0; x0 < size.x; x0 += 16) {
          std::vector<T> tile(256);
          for (int y = 0; y < std::min(16, size.y - y0); ++y)
            for (int x = 0; x < std::min(16, size.x - x0); ++x)
              tile[static_cast<std::size_t>(16 * y + x)] = volume.at({x0 + x, y0 + y, z});
          TIFFWriteTile(tiff, tile.data(), static_cast<std::uint32_t>(x0),
                        static_cast<std::uint32_t>(y0), 0, 0);
        }
    } else {
      for (int y = 0; y < size.y; ++y) {
        std::vector<T> row;
        for (int x = 0; x < size.x; ++x) row.push_back(volume.at({x, y, z}));
        TIFFWriteScanline(tiff, row.data(), static_cast<std::uint32_t>(y), 0);
      }
    }
    TIFFWriteDirectory(tiff);
  }
  template <class T>
  void write_stack(const std::string& name, const RandomVolume<T>& volume,
                   const TiffLayout& layout = {}) const {
    const File file = create(name, layout.mode);
    for (int z = 0; z < volume.size.z; ++z) write_page(file.get(), volume, z, layout);
  }
  template <class T>
  void check_type() const {
    unsigned seed = 7;
    for (const char* mode : {"w", "wb", "w8"})
      for (const int compression : {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_ADOBE_DEFLATE})
        for (const bool is_tiled : {false, true}) {
          const RandomVolume<T> volume({19, 5, 3}, ++seed);
          write_stack("v.tif", volume, {mode, compression, is_tiled});
          EXPECT_EQ(read("v.tif").voxels, volume.voxels_not_0()) << mode << compression << is_tiled;
          EXPECT_EQ(read("v.tif", 2.0).voxels, volume.voxels([](T v) { return v >= 2; }));
        }
  }
};

TEST_F(Tiff, EveryTypeAndLayoutIsRead) {
  check_type<std::uint8_t>();
  check_type<std::int8_t>();
  check_type<std::uint16_t>();
  check_type<std::int16_t>();
  check_type<std::uint32_t>();
  check_type<std::int32_t>();
  check_type<float>();
  check_type<double>();
}

TEST_F(Tiff, BitsAreReadFromBothSides) {
  for (const std::uint16_t photometric :
       {std::uint16_t{PHOTOMETRIC_MINISBLACK}, std::uint16_t{PHOTOMETRIC_MINISWHITE}}) {
    {
      const File file = create("v.tif");
      set_header<std::uint8_t>(file.get(), {11, 1, 1}, {.photometric = photometric}, 1);
      std::uint8_t row[2] = {0b10010000, 0b01100000};
      TIFFWriteScanline(file.get(), row, 0, 0);
    }
    std::vector<Vec3i> expected;
    for (const int x : photometric == PHOTOMETRIC_MINISBLACK
                           ? std::vector<int>{0, 3, 9, 10}
                           : std::vector<int>{1, 2, 4, 5, 6, 7, 8})
      expected.push_back({x, 0, 0});
    EXPECT_EQ(read("v.tif").voxels, expected);
  }
}

TEST_F(Tiff, AFolderIsAStack) {
  std::filesystem::create_directory(path("stack"));
  const RandomVolume<std::uint16_t> volume({4, 3, 11}, 3);
  for (int z = 0; z < volume.size.z; ++z) {
    const File file = create("stack/s" + std::to_string(z) + ".tif");
    write_page(file.get(), volume, z, {});
  }
  EXPECT_EQ(read("stack").voxels, volume.voxels_not_0());
  write_stack("stack/s11.tif", RandomVolume<std::uint16_t>({4, 4, 1}, 3));
  EXPECT_TRUE(has(error_of([&] { import("stack"); }), "s11.tif: differs from the first slice"));
  std::filesystem::remove(path("stack/s11.tif"));
  std::filesystem::remove(path("stack/s5.tif"));
  ASSERT_EQ(open("stack")->warnings().size(), 1u);
  EXPECT_TRUE(has(open("stack")->warnings()[0], "1 slice is missing"));
  write("stack/a.png", "");
  EXPECT_TRUE(has(error_of([&] { import("stack"); }), "has .png and .tif files"));
}

TEST_F(Tiff, PalettesAndColoursSetVoxels) {
  {
    const File file = create("v.tif");
    set_header<std::uint8_t>(file.get(), {2, 1, 1}, {.photometric = PHOTOMETRIC_RGB});
    TIFFSetField(file.get(), TIFFTAG_SAMPLESPERPIXEL, 3);
    TIFFSetField(file.get(), TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
    std::uint8_t row[6] = {0, 0, 0, 10, 20, 30};
    TIFFWriteScanline(file.get(), row, 0, 0);
  }
  const SourceVoxels all = read("v.tif");
  EXPECT_EQ(all.voxels, (std::vector<Vec3i>{{1, 0, 0}}));
  EXPECT_EQ(all.colors, (std::vector<Rgb8>{{10, 20, 30}}));
}

TEST_F(Tiff, ImageJAndOmeNameTheSidesOfVoxels) {
  const RandomVolume<std::uint8_t> volume({2, 2, 4}, 5);
  write_stack("v.tif", volume,
              {.description = "ImageJ=1.53\nimages=4\nslices=4\nunit=micron\nspacing=0.5\n",
               .pixels_per_unit = 2});
  ASSERT_TRUE(open("v.tif")->grid());
  EXPECT_DOUBLE_EQ(open("v.tif")->grid()->voxel_size, 0.5);
  write_stack("v.tif", volume,
              {.description = "<?xml?><OME><Image><Pixels SizeC=\"1\" SizeT=\"1\" SizeZ=\"4\" "
                              "PhysicalSizeX=\"0.25\" PhysicalSizeY=\"0.25\" "
                              "PhysicalSizeZ=\"0.25\"/></Image></OME>"});
  EXPECT_DOUBLE_EQ(open("v.tif")->grid()->voxel_size, 0.25);
  EXPECT_EQ(read("v.tif").voxels, volume.voxels_not_0());
  write_stack("v.tif", volume, {.description = "ImageJ=1.53\nimages=4\nchannels=2\nslices=2\n"});
  EXPECT_TRUE(has(error_of([&] { open("v.tif"); }), "has 2 channels"));
  write_stack("v.tif", volume, {.description = "ImageJ=1.53\nimages=40\nslices=40\n"});
  EXPECT_TRUE(has(error_of([&] { open("v.tif"); }), "names 40 slices, but has 4"));
}

TEST_F(Tiff, SlicesAfterTheOnlyPageAreRead) {
  // ImageJ writes stacks of more than 4 GiB in this way.
  const RandomVolume<std::uint16_t> volume({5, 4, 6}, 12);
  for (const char* mode : {"wl", "wb"}) {
    {
      const File file = create("v.tif", mode);
      set_header<std::uint16_t>(file.get(), volume.size,
                                {.description = "ImageJ=1.53\nimages=6\nslices=6\n"});
      TIFFSetField(file.get(), TIFFTAG_ROWSPERSTRIP, 4);
      std::vector<std::uint16_t> slice(volume.values.begin(), volume.values.begin() + 20);
      TIFFWriteEncodedStrip(file.get(), 0, slice.data(), 40);
    }
    // Writes the slices again at the end, and points the strip there.
    std::string bytes = read_text(path("v.tif"));
    const bool is_big_endian = mode[1] == 'b';
    const std::string first = volume.bytes(is_big_endian).substr(0, 40);
    const std::size_t at = bytes.find(first);
    std::string from, to;
    append(from, at, 4, is_big_endian);
    append(to, bytes.size(), 4, is_big_endian);
    const std::size_t entry = bytes.rfind(from);
    ASSERT_NE(entry, std::string::npos);
    bytes.replace(entry, 4, to);
    write("v.tif", bytes + volume.bytes(is_big_endian));
    EXPECT_EQ(read("v.tif").voxels, volume.voxels_not_0());
  }
}

TEST_F(Tiff, SmallerCopiesAreLeftOut) {
  const RandomVolume<std::uint8_t> volume({6, 4, 2}, 5);
  {
    const File file = create("v.tif");
    for (int z = 0; z < 2; ++z) {
      write_page(file.get(), volume, z, {});
      set_header<std::uint8_t>(file.get(), {3, 2, 1}, {});
      TIFFSetField(file.get(), TIFFTAG_SUBFILETYPE, FILETYPE_REDUCEDIMAGE);
      std::uint8_t row[3] = {9, 9, 9};
      for (std::uint32_t y = 0; y < 2; ++y) TIFFWriteScanline(file.get(), row, y, 0);
      TIFFWriteDirectory(file.get());
    }
  }
  EXPECT_EQ(read("v.tif").voxels, volume.voxels_not_0());
}

TEST_F(Tiff, BrokenFilesAreErrors) {
  EXPECT_TRUE(has(error_of_bytes("v.tif", "no tiff"), "v.tif"));
  const RandomVolume<std::uint8_t> volume({9, 7, 2}, 5);
  for (const int compression : {COMPRESSION_NONE, COMPRESSION_LZW}) {
    write_stack("good.tif", volume, {.compression = compression});
    const std::string good = read_text(path("good.tif"));
    expect_no_prefix_is_read("v.tif", good);
    EXPECT_GT(flip_every_bit("v.tif", good), 100);
  }
}

}  // namespace
}  // namespace voxdag
#endif
