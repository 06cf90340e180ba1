#include "voxdag/image/png.hpp"

#include <png.h>

#include <algorithm>
#include <bit>
#include <csetjmp>
#include <cstring>
#include <string>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/image/image_limits.hpp"
#include "voxdag/image/png_silence.hpp"

namespace voxdag {
namespace {

/// Deflate expands data at most 1032 times, so a file has at most this many one-bit pixels for each
/// of its bytes.
constexpr std::uint64_t kMaxPixelsPerByte = 1032 * 8;
/// Chunks that are skipped, because libpng would unpack a few kilobytes of them to megabytes.
constexpr png_byte kSkippedChunks[] = "tEXt\0zTXt\0iTXt\0iCCP\0sPLT\0eXIf";

std::uint32_t big_endian32(const std::uint8_t* p) {
  return std::uint32_t{p[0]} << 24 | std::uint32_t{p[1]} << 16 | std::uint32_t{p[2]} << 8 | p[3];
}

/// Throws Error unless the chunks reach IEND. libpng stops at the last pixel and would not notice a
/// missing end.
void require_whole(const std::string& file, std::span<const std::uint8_t> bytes) {
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

/// Checks the size in the header before libpng reads it.
void require_sane_size(const std::string& file, std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 24 || std::memcmp(bytes.data() + 12, "IHDR", 4) != 0)
    throw Error(file, "byte 8", "damaged PNG file: the first chunk is not the header");
  const std::uint64_t width = big_endian32(&bytes[16]), height = big_endian32(&bytes[20]);
  check_image_size(file, width, height);
  if (width * height / kMaxPixelsPerByte > bytes.size())
    throw Error(file, "header",
                "the file is too short for " + std::to_string(width) + " x " +
                    std::to_string(height) + " pixels");
}

/// libpng's structures for reading, which the destructor frees, and the data of its callbacks.
struct PngDecoder {
  png_structp png = nullptr;
  png_infop info = nullptr;
  std::span<const std::uint8_t> rest;
  std::string message;

  explicit PngDecoder(std::span<const std::uint8_t> bytes) : rest(bytes) {}
  PngDecoder(const PngDecoder&) = delete;
  PngDecoder& operator=(const PngDecoder&) = delete;
  ~PngDecoder() { png_destroy_read_struct(&png, &info, nullptr); }
};

[[noreturn]] void on_error(png_structp png, png_const_charp message) {
  static_cast<PngDecoder*>(png_get_error_ptr(png))->message = message;
  png_longjmp(png, 1);
}
void on_read(png_structp png, png_bytep to, png_size_t size) {
  auto& rest = static_cast<PngDecoder*>(png_get_io_ptr(png))->rest;
  if (size > rest.size()) png_error(png, "the file ends inside a chunk");
  std::memcpy(to, rest.data(), size);
  rest = rest.subspan(size);
}

// libpng's errors jump to the functions below. No object with a destructor may live in them. They
// return false if decoding failed.

bool read_header(PngDecoder& decoder) {
  decoder.png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &decoder, on_error, ignore_warning);
  decoder.info = decoder.png == nullptr ? nullptr : png_create_info_struct(decoder.png);
  if (decoder.info == nullptr || setjmp(png_jmpbuf(decoder.png))) return false;
  png_structp png = decoder.png;
  png_set_read_fn(png, &decoder, on_read);
  png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, kSkippedChunks,
                              sizeof kSkippedChunks / 5);
  png_read_info(png, decoder.info);
  png_set_expand(png);  // Expands palettes, few bits and transparent colours.
  if constexpr (std::endian::native == std::endian::little) png_set_swap(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, decoder.info);
  return true;
}

bool read_row(PngDecoder& decoder, std::uint8_t* row) {
  if (setjmp(png_jmpbuf(decoder.png))) return false;
  png_read_row(decoder.png, row, nullptr);
  return true;
}

bool read_end(PngDecoder& decoder) {
  if (setjmp(png_jmpbuf(decoder.png))) return false;
  png_read_end(decoder.png, nullptr);
  return true;
}

bool read_rows(PngDecoder& decoder, DecodedImage& image, const ImageOptions& options) {
  constexpr int kAdam7Passes = 7;
  const bool is_interlaced =
      png_get_interlace_type(decoder.png, decoder.info) == PNG_INTERLACE_ADAM7;
  for (int pass = 0; pass < (is_interlaced ? kAdam7Passes : 1); ++pass)
    for (int y = 0; y < image.height(); ++y) {
      options.call_poll();
      if (!read_row(decoder, image.row(y))) return false;
    }
  return read_end(decoder);
}

}  // namespace

bool is_png(std::span<const std::uint8_t> bytes) {
  constexpr std::uint8_t kSignature[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1A, '\n'};
  return bytes.size() >= 8 && std::memcmp(bytes.data(), kSignature, 8) == 0;
}

DecodedImage decode_png(std::span<const std::uint8_t> bytes, const std::string& name,
                        const ImageOptions& options) {
  if (!is_png(bytes)) throw Error(name, "byte 0", "not a PNG file");
  require_whole(name, bytes);
  require_sane_size(name, bytes);
  PngDecoder decoder(bytes);
  const auto damaged = [&] { return Error(name, "", "damaged PNG file: " + decoder.message); };
  if (!read_header(decoder)) throw damaged();
  DecodedImage image(static_cast<int>(png_get_image_width(decoder.png, decoder.info)),
                     static_cast<int>(png_get_image_height(decoder.png, decoder.info)),
                     png_get_channels(decoder.png, decoder.info),
                     png_get_bit_depth(decoder.png, decoder.info) / 8, options.memory);
  if (png_get_rowbytes(decoder.png, decoder.info) != image.row_bytes())
    throw Error(name, "", "damaged PNG file: rows of an unexpected length");
  if (!read_rows(decoder, image, options)) throw damaged();
  return image;
}

void write_png(const std::filesystem::path& path, const ImageRgb8& image,
               std::span<const std::uint8_t> alpha) {
  if (image.width <= 0 || image.height <= 0 ||
      image.pixels.size() != ImageRgb8(image.width, image.height).pixels.size())
    throw Error(path.string(), "",
                "cannot write: the number of pixels does not match the size of the image");
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = alpha.empty() ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
  std::vector<std::uint8_t> rgba(4 * alpha.size());
  for (std::size_t i = 0; i < alpha.size(); ++i) {
    std::copy_n(image.pixels.begin() + static_cast<std::ptrdiff_t>(3 * i), 3,
                rgba.begin() + static_cast<std::ptrdiff_t>(4 * i));
    rgba[4 * i + 3] = alpha[i];
  }
  const std::uint8_t* const pixels = alpha.empty() ? image.pixels.data() : rgba.data();
  std::vector<std::uint8_t> bytes(PNG_IMAGE_PNG_SIZE_MAX(png));
  png_alloc_size_t size = bytes.size();
  const int is_written =
      png_image_write_to_memory(&png, bytes.data(), &size, 0, pixels, 0, nullptr);
  png_image_free(&png);
  if (is_written == 0) throw Error(path.string(), "", std::string("cannot write: ") + png.message);
  write_whole_file(path, {reinterpret_cast<const char*>(bytes.data()), size});
}

}  // namespace voxdag
