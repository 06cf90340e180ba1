#include "voxdag/image/jpeg.hpp"

#include <csetjmp>
#include <cstdio>
// jpeglib.h needs <cstdio> before it.
#include <jpeglib.h>
// jerror.h needs jpeglib.h before it.
#include <jerror.h>

#include <string>

#include "voxdag/core/error.hpp"
#include "voxdag/image/image_file.hpp"

namespace voxdag {
namespace {

/// libjpeg reports through callbacks that must not return: errors jump to where decoding began.
struct JpegErrors : jpeg_error_mgr {
  std::jmp_buf escape;
  char message[JMSG_LENGTH_MAX] = {};

  JpegErrors() {
    jpeg_std_error(this);
    error_exit = [](j_common_ptr info) { self(info).leave(info); };
    output_message = [](j_common_ptr) {};
    emit_message = [](j_common_ptr info, int level) {
      // libjpeg fills what is missing of a truncated file with grey and only warns.
      const int code = info->err->msg_code;
      if (level < 0 && (code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER)) self(info).leave(info);
    };
  }

 private:
  static JpegErrors& self(j_common_ptr info) { return *static_cast<JpegErrors*>(info->err); }
  [[noreturn]] void leave(j_common_ptr info) {
    format_message(info, message);
    std::longjmp(escape, 1);
  }
};

/// Decodes into `image`. False: `errors.message` says why. Nothing with a destructor lives across
/// the jump except what the caller owns.
bool decode(std::span<const std::uint8_t> bytes, JpegErrors& errors, ImageRgb8& image) {
  jpeg_decompress_struct info{};
  info.err = &errors;
  jpeg_create_decompress(&info);
  if (setjmp(errors.escape)) {
    jpeg_destroy_decompress(&info);
    return false;
  }
  jpeg_mem_src(&info, bytes.data(), bytes.size());
  jpeg_read_header(&info, TRUE);
  if (std::uint64_t{info.image_width} * info.image_height > kMaxImagePixels) {
    std::snprintf(errors.message, sizeof errors.message, "absurd size %u x %u", info.image_width,
                  info.image_height);
    jpeg_destroy_decompress(&info);
    return false;
  }
  info.out_color_space = JCS_RGB;
  jpeg_start_decompress(&info);
  image = ImageRgb8(static_cast<int>(info.output_width), static_cast<int>(info.output_height));
  while (info.output_scanline < info.output_height) {
    JSAMPROW row = image.pixel(0, static_cast<int>(info.output_scanline));
    jpeg_read_scanlines(&info, &row, 1);
  }
  jpeg_finish_decompress(&info);
  jpeg_destroy_decompress(&info);
  return true;
}

}  // namespace

ImageRgb8 read_jpeg(const std::filesystem::path& path) {
  return decode_jpeg(encoded_bytes(map_image(path)), path.string());
}

ImageRgb8 decode_jpeg(std::span<const std::uint8_t> bytes, const std::string& name) {
  if (bytes.size() < 2 || bytes[0] != 0xFF || bytes[1] != 0xD8)
    throw Error(name, "byte 0", "not a JPEG file");
  JpegErrors errors;
  ImageRgb8 image;
  if (!decode(bytes, errors, image))
    throw Error(name, "", std::string("damaged JPEG file: ") + errors.message);
  return image;
}

}  // namespace voxdag
