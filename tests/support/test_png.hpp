#pragma once
/// Writes PNG files of any kind for tests, with libpng.
#include <png.h>

#include <bit>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <stdexcept>
#include <vector>

namespace voxdag {

/// Writes `samples`, row by row: 1 (grey), 2 (grey, alpha), 3 (RGB) or 4 (RGBA) per pixel, of 8 or
/// 16 bits. Ends the program if libpng refuses them.
inline void write_test_png(const std::filesystem::path& path, int width, int height, int channels,
                           int bits, const std::vector<std::uint16_t>& samples,
                           bool interlaced = false) {
  constexpr int kTypes[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                            PNG_COLOR_TYPE_RGB_ALPHA};
  std::FILE* file = std::fopen(path.c_str(), "wb");
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  if (file == nullptr) throw std::runtime_error("cannot write a PNG");
  png_init_io(png, file);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), bits,
               kTypes[channels - 1], interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  std::vector<std::uint8_t> bytes;
  for (const std::uint16_t sample : samples) {
    if (bits == 16) bytes.push_back(static_cast<std::uint8_t>(sample >> 8));
    bytes.push_back(static_cast<std::uint8_t>(sample));
  }
  std::vector<png_bytep> rows;
  for (int y = 0; y < height; ++y)
    rows.push_back(bytes.data() +
                   bytes.size() / static_cast<std::size_t>(height) * static_cast<std::size_t>(y));
  png_write_image(png, rows.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
}

}  // namespace voxdag
