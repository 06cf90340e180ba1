/// Tests small files that would cost much memory or time.
#include <gtest/gtest.h>
#include <png.h>

#include <cstdio>
#include <cstdlib>
#include <vector>
// jpeglib.h needs <cstdio> before it.
#include <jpeglib.h>

#include "support/temp_dir.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/image/decode.hpp"
#include "voxdag/image/texture.hpp"

namespace voxdag {
namespace {

constexpr std::uint64_t kMebibyte = 1 << 20;

/// Writes black pixels of one bit.
void write_one_bit_png(const std::filesystem::path& path, int side) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  const auto size = static_cast<png_uint_32>(side);
  png_set_IHDR(png, info, size, size, 1, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  const std::vector<png_byte> row(static_cast<std::size_t>(side) / 8 + 1);
  for (int y = 0; y < side; ++y) png_write_row(png, row.data());
  png_write_end(png, info);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
}

/// Encodes a grey progressive JPEG and repeats its last scan.
std::vector<std::uint8_t> progressive_jpeg(int side, int extra_scans) {
  jpeg_compress_struct info{};
  jpeg_error_mgr errors;
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* encoded = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&info, &encoded, &size);
  info.image_width = info.image_height = static_cast<JDIMENSION>(side);
  info.input_components = 1;
  info.in_color_space = JCS_GRAYSCALE;
  jpeg_set_defaults(&info);
  jpeg_simple_progression(&info);
  jpeg_start_compress(&info, TRUE);
  std::vector<JSAMPLE> samples(static_cast<std::size_t>(side), 77);
  JSAMPROW row = samples.data();
  while (info.next_scanline < info.image_height) jpeg_write_scanlines(&info, &row, 1);
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  std::vector<std::uint8_t> bytes(encoded, encoded + size - 2);  // without the end marker
  std::free(encoded);
  std::size_t last = bytes.size() - 2;
  while (bytes[last] != 0xFF || bytes[last + 1] != 0xDA) --last;
  const std::vector<std::uint8_t> scan(bytes.begin() + static_cast<std::ptrdiff_t>(last),
                                       bytes.end());
  for (int i = 0; i < extra_scans; ++i) bytes.insert(bytes.end(), scan.begin(), scan.end());
  bytes.insert(bytes.end(), {0xFF, 0xD9});
  return bytes;
}

TEST(HostileImage, AOneBitPngIsRefusedBeforeItsPixelsTakeMemory) {
  const TempDir dir;
  const std::filesystem::path path = dir / "bits.png";
  write_one_bit_png(path, 16384);
  EXPECT_LT(std::filesystem::file_size(path), 40000u);
  MemoryBudget memory(100 * kMebibyte);
  try {
    read_image(path, {&memory, {}});
    ADD_FAILURE() << "no error";
  } catch (const OverMemory& error) {
    EXPECT_EQ(
        std::string(error.what()),
        path.string() + ": the memory limit of 100 MiB is too small: at least 256 MiB are needed");
  }
  EXPECT_LE(memory.peak(), 100 * kMebibyte);
  EXPECT_EQ(memory.used(), 0u);
}

TEST(HostileImage, ImagesAndTexturesCountEveryByteWhileTheyLive) {
  const TempDir dir;
  write_one_bit_png(dir / "bits.png", 1024);
  MemoryBudget memory;
  {
    const DecodedImage image = read_image(dir / "bits.png", {&memory, {}});
    EXPECT_EQ(memory.used(), kMebibyte);  // one byte per pixel
    const Texture texture = make_color_texture(image, 0, {}, {&memory, {}});
    EXPECT_NEAR(static_cast<double>(texture.bytes()), 16.0 * kMebibyte, 0.1 * kMebibyte);
    EXPECT_GE(memory.used(), kMebibyte + texture.bytes());
    EXPECT_LE(memory.used(), kMebibyte + texture.bytes() + kMebibyte);
  }
  EXPECT_EQ(memory.used(), 0u);
  MemoryBudget small(10 * kMebibyte);
  const DecodedImage image = read_image(dir / "bits.png", {&small, {}});
  EXPECT_THROW(make_color_texture(image, 0, {}, {&small, {}}), OverMemory);
  EXPECT_THROW(make_bump_texture(image, 1, {}, {&small, {}}), OverMemory);
}

TEST(HostileImage, AProgressiveJpegCountsItsCoefficients) {
  const std::vector<std::uint8_t> bytes = progressive_jpeg(2048, 0);
  MemoryBudget memory;
  decode_image(bytes, "a.jpg", {&memory, {}});
  // A byte per pixel, two bytes per coefficient, 4 MiB for tables.
  EXPECT_EQ(memory.peak(), (4 + 8 + 4) * kMebibyte);
  MemoryBudget small(15 * kMebibyte);
  EXPECT_THROW(decode_image(bytes, "a.jpg", {&small, {}}), OverMemory);
}

TEST(HostileImage, AJpegOfTooManyScansIsRefused) {
  EXPECT_NO_THROW(decode_image(progressive_jpeg(64, 40), "a.jpg"));
  try {
    decode_image(progressive_jpeg(64, 200), "a.jpg");
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.reason(),
              "damaged JPEG file: scan 65 of 64 x 64 pixels exceeds the limits of 64 scans and "
              "4294967296 pixels in all scans");
  }
}

TEST(HostileImage, ASparseFileIsRefusedByItsSizeOrItsFirstBytes) {
  const TempDir dir;
  for (const auto& [size, reason] :
       {std::pair(std::uintmax_t{3} << 30,
                  "3221225472 bytes are more than the limit of 1024 MiB for an image"),
        {std::uintmax_t{1} << 30, "not an image: PNG, JPEG, WebP, BMP and TGA images are read"}}) {
    write_text(dir / "a.png", "");
    std::filesystem::resize_file(dir / "a.png", size);
    try {
      read_image(dir / "a.png");
      ADD_FAILURE() << "no error";
    } catch (const Error& error) {
      EXPECT_EQ(error.file(), (dir / "a.png").string());
      EXPECT_EQ(error.reason(), reason);
    }
  }
}

/// Expects that `work(options)`, on an image of 2048 rows, polls for every 32 rows or oftener, and
/// stops when poll() throws.
template <class Work>
void expect_stoppable(const Work& work) {
  ImageOptions options;
  int polls = 0;
  options.poll = [&polls] { ++polls; };
  work(options);
  EXPECT_GE(polls, 2048 / 32);
  polls = 0;
  options.poll = [&polls] {
    if (++polls == 10) throw Cancelled();
  };
  EXPECT_THROW(work(options), Cancelled);
  EXPECT_EQ(polls, 10);
}

TEST(HostileImage, DecodingAndTexturesCanBeStopped) {
  const TempDir dir;
  write_one_bit_png(dir / "bits.png", 2048);
  const std::vector<std::uint8_t> jpeg = progressive_jpeg(2048, 10);
  expect_stoppable([&](const ImageOptions& options) { read_image(dir / "bits.png", options); });
  expect_stoppable([&](const ImageOptions& options) { decode_image(jpeg, "a.jpg", options); });
  const DecodedImage image = read_image(dir / "bits.png");
  expect_stoppable([&](const ImageOptions& options) { make_color_texture(image, 0, {}, options); });
  expect_stoppable([&](const ImageOptions& options) { make_bump_texture(image, 1, {}, options); });
  expect_stoppable([&](const ImageOptions& options) {
    with_alpha_of(image, DecodedImage(1, 1, 4, 2, nullptr), options);
  });
}

}  // namespace
}  // namespace voxdag
