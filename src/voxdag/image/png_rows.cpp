#include "voxdag/image/png_rows.hpp"

#include <png.h>

#include <csetjmp>
#include <string>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/image/png_silence.hpp"

namespace voxdag {

/// libpng's structures for writing, and what its callbacks use. Callbacks only fill `bytes`: an
/// exception must not pass through libpng.
struct PngRowWriter::Encoder {
  png_structp png = nullptr;
  png_infop info = nullptr;
  AtomicFile file;
  std::vector<std::uint8_t> bytes;
  std::string message;

  explicit Encoder(const std::filesystem::path& path) : file(path) {}
  Encoder(const Encoder&) = delete;
  Encoder& operator=(const Encoder&) = delete;
  ~Encoder() { png_destroy_write_struct(&png, &info); }

  [[noreturn]] void fail() const {
    throw Error(file.path().string(), "", "cannot write: " + message);
  }
  void flush() {
    file.write(bytes.data(), bytes.size());
    bytes.clear();
  }
};

namespace {

// libpng's errors jump to the functions that return bool. No object with a destructor may live in
// them.

template <class Encoder>
Encoder& encoder_of(png_voidp pointer) {
  return *static_cast<Encoder*>(pointer);
}

template <class Encoder>
[[noreturn]] void on_error(png_structp png, png_const_charp message) {
  encoder_of<Encoder>(png_get_error_ptr(png)).message = message;
  png_longjmp(png, 1);
}
template <class Encoder>
void on_write(png_structp png, png_bytep data, png_size_t size) {
  try {
    auto& bytes = encoder_of<Encoder>(png_get_io_ptr(png)).bytes;
    bytes.insert(bytes.end(), data, data + size);
  } catch (const std::bad_alloc&) {
    png_error(png, "out of memory");
  }
}
void on_flush(png_structp) {}

template <class Encoder>
bool begin(Encoder& encoder, std::uint32_t width, std::uint32_t height, PngPixels pixels) {
  encoder.png =
      png_create_write_struct(PNG_LIBPNG_VER_STRING, &encoder, on_error<Encoder>, ignore_warning);
  encoder.info = encoder.png == nullptr ? nullptr : png_create_info_struct(encoder.png);
  if (encoder.info == nullptr || setjmp(png_jmpbuf(encoder.png))) return false;
  png_structp png = encoder.png;
  png_set_write_fn(png, &encoder, on_write<Encoder>, on_flush);
  png_set_user_limits(png, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
  const bool is_bits = pixels == PngPixels::kBits;
  png_set_IHDR(png, encoder.info, width, height, is_bits ? 1 : 8,
               is_bits ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGBA, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (!is_bits) png_set_sRGB(png, encoder.info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(png, encoder.info);
  return true;
}

template <class Encoder>
bool add_row(Encoder& encoder, const std::uint8_t* row) {
  if (setjmp(png_jmpbuf(encoder.png))) return false;
  png_write_row(encoder.png, row);
  return true;
}

template <class Encoder>
bool end(Encoder& encoder) {
  if (setjmp(png_jmpbuf(encoder.png))) return false;
  png_write_end(encoder.png, nullptr);
  return true;
}

}  // namespace

PngRowWriter::PngRowWriter(const std::filesystem::path& path, std::uint32_t width,
                           std::uint32_t height, PngPixels pixels)
    : encoder_(std::make_unique<Encoder>(path)) {
  if (!begin(*encoder_, width, height, pixels)) encoder_->fail();
}

PngRowWriter::~PngRowWriter() = default;

void PngRowWriter::write(std::span<const std::uint8_t> row) {
  if (!add_row(*encoder_, row.data())) encoder_->fail();
  encoder_->flush();
}

void PngRowWriter::commit() {
  if (!end(*encoder_)) encoder_->fail();
  encoder_->flush();
  encoder_->file.commit();
}

}  // namespace voxdag
