#include "voxdag/image/png.hpp"

#include <png.h>

#include <bit>
#include <csetjmp>
#include <cstring>
#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/image/image_file.hpp"
#include "voxdag/io/atomic_file.hpp"

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
void require_whole(const std::string& file, std::span<const std::uint8_t> bytes) {
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
  throw Error(file, ErrorPlace::byte(bytes.size()), "the PNG file is truncated");
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

void require_sane_size(const std::string& file, std::uint32_t width, std::uint32_t height,
                       std::size_t bytes) {
  const std::uint64_t pixels = std::uint64_t{width} * height;
  if (pixels > kMaxImagePixels || pixels / kMaxPixelsPerByte > bytes)
    throw Error(file, "header",
                "absurd size " + std::to_string(width) + " x " + std::to_string(height));
}

/// What libpng's callbacks share with their caller. Errors jump to where decoding began.
struct PngDecoding {
  std::span<const std::uint8_t> rest;
  std::string message;
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
  static_cast<PngDecoding*>(png_get_error_ptr(png))->message = message;
  png_longjmp(png, 1);
}
void on_warning(png_structp, png_const_charp) {}
void on_read(png_structp png, png_bytep to, png_size_t size) {
  auto& rest = static_cast<PngDecoding*>(png_get_io_ptr(png))->rest;
  if (size > rest.size()) png_error(png, "the file ends inside a chunk");
  std::memcpy(to, rest.data(), size);
  rest = rest.subspan(size);
}

/// Decodes the rows into `image`, which has the right size. False: `decoding.message` says why.
/// Nothing with a destructor lives across the jump except what the caller owns.
bool decode_rows(PngDecoding& decoding, ImageRgba16& image, std::vector<png_bytep>& rows) {
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &decoding, on_error, on_warning);
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  if (info == nullptr || setjmp(png_jmpbuf(png))) {
    png_destroy_read_struct(&png, &info, nullptr);
    return false;
  }
  png_set_read_fn(png, &decoding, on_read);
  png_read_info(png, info);
  image.has_alpha = (png_get_color_type(png, info) & PNG_COLOR_MASK_ALPHA) != 0 ||
                    png_get_valid(png, info, PNG_INFO_tRNS) != 0;
  png_set_expand_16(png);  // Palettes, few bits and transparent colours too.
  png_set_gray_to_rgb(png);
  png_set_add_alpha(png, 0xFFFF, PNG_FILLER_AFTER);
  if constexpr (std::endian::native == std::endian::little) png_set_swap(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  if (png_get_rowbytes(png, info) != static_cast<std::size_t>(image.width) * 8)
    png_error(png, "rows of an unexpected length");
  png_read_image(png, rows.data());
  png_read_end(png, nullptr);
  png_destroy_read_struct(&png, &info, nullptr);
  return true;
}

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
  write_whole_file(path, {reinterpret_cast<const char*>(bytes.data()), size});
}

ImageRgb8 read_png(const std::filesystem::path& path) {
  const std::string file = path.string();
  const MappedFile mapping = map_image(path);
  const std::span<const std::uint8_t> bytes = encoded_bytes(mapping);
  require_whole(file, bytes);
  PngImage png;
  if (!png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) || png.failed())
    throw Error(file, "", std::string("damaged PNG file: ") + png.message);
  require_sane_size(file, png.width, png.height, bytes.size());
  const std::uint64_t pixels = std::uint64_t{png.width} * png.height;
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

ImageRgba16 decode_png_rgba16(std::span<const std::uint8_t> bytes, const std::string& name) {
  require_whole(name, bytes);
  // The first chunk is IHDR, with the size first: read here, so that it can be refused.
  if (bytes.size() < 24 || std::memcmp(bytes.data() + 12, "IHDR", 4) != 0)
    throw Error(name, "byte 8", "damaged PNG file: the header is not first");
  const std::uint32_t width = big_endian32(&bytes[16]), height = big_endian32(&bytes[20]);
  require_sane_size(name, width, height, bytes.size());
  if (width == 0 || height == 0 || width > PNG_USER_WIDTH_MAX || height > PNG_USER_HEIGHT_MAX)
    throw Error(name, "header",
                "absurd size " + std::to_string(width) + " x " + std::to_string(height));
  ImageRgba16 image(static_cast<int>(width), static_cast<int>(height));
  std::vector<png_bytep> rows;
  rows.reserve(height);
  for (int y = 0; y < image.height; ++y)
    rows.push_back(reinterpret_cast<png_bytep>(image.pixel(0, y)));
  PngDecoding decoding{bytes, ""};
  if (!decode_rows(decoding, image, rows))
    throw Error(name, "", "damaged PNG file: " + decoding.message);
  return image;
}

}  // namespace voxdag
