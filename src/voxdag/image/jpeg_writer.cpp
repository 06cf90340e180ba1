#include "voxdag/image/jpeg_writer.hpp"

#include <csetjmp>
#include <cstdio>
#include <cstdlib>
// jpeglib.h needs <cstdio> before it.
#include <jpeglib.h>

#include "voxdag/core/error.hpp"

namespace voxdag {
namespace {

/// A compressor that owns its output. As in jpeg.cpp, an error jumps to the caller of libjpeg.
struct JpegEncoder {
  jpeg_compress_struct info{};
  jpeg_error_mgr errors{};
  std::jmp_buf escape;
  char message[JMSG_LENGTH_MAX] = {};
  unsigned char* bytes = nullptr;
  unsigned long size = 0;

  JpegEncoder() {
    info.err = jpeg_std_error(&errors);
    info.client_data = this;
    errors.output_message = [](j_common_ptr) {};
    errors.error_exit = [](j_common_ptr common) {
      auto& self = *static_cast<JpegEncoder*>(common->client_data);
      self.errors.format_message(common, self.message);
      std::longjmp(self.escape, 1);
    };
  }
  JpegEncoder(const JpegEncoder&) = delete;
  JpegEncoder& operator=(const JpegEncoder&) = delete;
  ~JpegEncoder() {
    jpeg_destroy_compress(&info);
    std::free(bytes);
  }
};

/// Returns false after an error. No object with a destructor may live here.
bool write_rows(JpegEncoder& encoder, const ImageRgb8& image, int quality) {
  if (setjmp(encoder.escape)) return false;
  jpeg_compress_struct& info = encoder.info;
  jpeg_create_compress(&info);
  jpeg_mem_dest(&info, &encoder.bytes, &encoder.size);
  info.image_width = static_cast<JDIMENSION>(image.width);
  info.image_height = static_cast<JDIMENSION>(image.height);
  info.input_components = 3;
  info.in_color_space = JCS_RGB;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, quality, TRUE);
  info.optimize_coding = TRUE;
  jpeg_start_compress(&info, TRUE);
  while (info.next_scanline < info.image_height) {
    auto* row = const_cast<JSAMPROW>(image.pixel(0, static_cast<int>(info.next_scanline)));
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  return true;
}

}  // namespace

std::string encode_jpeg(const ImageRgb8& image, int quality) {
  JpegEncoder encoder;
  if (!write_rows(encoder, image, quality))
    throw Error("cannot write a JPEG: " + std::string(encoder.message));
  return {reinterpret_cast<const char*>(encoder.bytes), encoder.size};
}

}  // namespace voxdag
