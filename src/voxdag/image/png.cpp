#include "voxdag/image/png.hpp"

#include <png.h>

#include <cstring>
#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/image/file_bytes.hpp"

namespace voxdag {
namespace {

/// Deflate expands at most 1032 times, so a file cannot hold more one-bit pixels than this for each
/// of its bytes.
constexpr std::uint64_t kMaxPixelsPerByte = 1032 * 8;

std::uint32_t big_endian32(const std::uint8_t* p) {
  return std::uint32_t{p[0]} << 24 | std::uint32_t{p[1]} << 16 | std::uint32_t{p[2]} << 8 | p[3];
}

/// Walks the chunks up to IEND: libpng's simple reader stops at the last pixel and would not notice
/// that the end is missing.
void require_whole(const std::string& file, const std::vector<std::uint8_t>& bytes) {
  constexpr std::uint8_t kSignature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  if (bytes.size() < 8 || std::memcmp(bytes.data(), kSignature, 8) != 0)
    throw Error(file, "byte 0", "not a PNG file");
  for (std::size_t at = 8;;) {
    if (bytes.size() - at < 12) break;
    const std::uint8_t* chunk = bytes.data() + at;
    const std::size_t length = big_endian32(chunk);
    if (bytes.size() - at - 12 < length) break;
    if (std::memcmp(chunk + 4, "IEND", 4) == 0) return;
    at += length + 12;
  }
  throw Error(file, "byte " + std::to_string(bytes.size()), "the PNG file is truncated");
}

/// libpng's control structure, freed on every way out.
struct PngImage : png_image {
  PngImage() {
    std::memset(static_cast<png_image*>(this), 0, sizeof(png_image));
    version = PNG_IMAGE_VERSION;
  }
  PngImage(const PngImage&) = delete;
  PngImage& operator=(const PngImage&) = delete;
  ~PngImage() { png_image_free(this); }
  bool failed() const { return PNG_IMAGE_FAILED(*this); }
};

}  // namespace

void write_png(const std::filesystem::path& path, const ImageRgb8& image) {
  if (image.width <= 0 || image.height <= 0 ||
      image.pixels.size() != ImageRgb8(image.width, image.height).pixels.size())
    throw Error(path.string(), "", "cannot write: the image has no pixels or the wrong number");
  PngImage png;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  std::vector<std::uint8_t> bytes(PNG_IMAGE_PNG_SIZE_MAX(png));
  png_alloc_size_t size = bytes.size();
  if (!png_image_write_to_memory(&png, bytes.data(), &size, 0, image.pixels.data(), 0, nullptr))
    throw Error(path.string(), "", std::string("cannot write: ") + png.message);
  write_image_bytes(path, {bytes.data(), size});
}

ImageRgb8 read_png(const std::filesystem::path& path) {
  const std::string file = path.string();
  const std::vector<std::uint8_t> bytes = read_image_bytes(path);
  require_whole(file, bytes);
  PngImage png;
  if (!png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) || png.failed())
    throw Error(file, "", std::string("damaged PNG file: ") + png.message);
  const std::uint64_t pixels = std::uint64_t{png.width} * png.height;
  if (pixels > kMaxImagePixels || pixels / kMaxPixelsPerByte > bytes.size())
    throw Error(file, "header",
                "absurd size " + std::to_string(png.width) + " x " + std::to_string(png.height));
  png.format = PNG_FORMAT_RGBA;
  std::vector<std::uint8_t> rgba(PNG_IMAGE_SIZE(png));
  const int width = static_cast<int>(png.width), height = static_cast<int>(png.height);
  if (!png_image_finish_read(&png, nullptr, rgba.data(), 0, nullptr) || png.failed())
    throw Error(file, "", std::string("damaged PNG file: ") + png.message);
  ImageRgb8 image(width, height);
  for (std::size_t i = 0; i < pixels; ++i)
    for (std::size_t c = 0; c < 3; ++c) image.pixels[3 * i + c] = rgba[4 * i + c];
  return image;
}

}  // namespace voxdag
