#include "voxdag/image/jpeg.hpp"

#include <csetjmp>
#include <cstdio>
// jpeglib.h needs <cstdio> before it.
#include <jpeglib.h>
// jerror.h needs jpeglib.h before it.
#include <jerror.h>

#include <cstdlib>
#include <exception>
#include <string>
#include <vector>

#include "voxdag/core/error.hpp"
#include "voxdag/image/image_limits.hpp"

namespace voxdag {
namespace {

/// Memory of libjpeg without the coefficients: tables and rows.
constexpr std::uint64_t kJpegWorkBytes = std::uint64_t{4} << 20;

/// A decompressor and libjpeg's callbacks. An error callback must not return, and no exception may
/// pass through libjpeg. So both jump (longjmp) to the caller of the decoder.
struct JpegDecoder {
  jpeg_decompress_struct info{};
  jpeg_error_mgr errors{};
  jpeg_progress_mgr monitor{};
  std::jmp_buf escape;
  char message[JMSG_LENGTH_MAX] = {};
  bool is_unsupported = false;  ///< The message is about a kind of JPEG, not about damage.
  const ImageOptions& options;
  std::exception_ptr thrown;  ///< Exception of options.poll, rethrown after the jump.

  explicit JpegDecoder(const ImageOptions& image_options) : options(image_options) {
    info.err = jpeg_std_error(&errors);
    info.client_data = this;
    errors.error_exit = [](j_common_ptr common) { self(common).leave(); };
    errors.output_message = [](j_common_ptr) {};
    errors.emit_message = [](j_common_ptr common, int level) {
      // libjpeg fills the missing part of a truncated file with grey and only warns.
      const int code = common->err->msg_code;
      if (level < 0 && (code == JWRN_JPEG_EOF || code == JWRN_HIT_MARKER)) self(common).leave();
    };
    monitor.progress_monitor = [](j_common_ptr common) { self(common).on_progress(); };
  }
  JpegDecoder(const JpegDecoder&) = delete;
  JpegDecoder& operator=(const JpegDecoder&) = delete;
  ~JpegDecoder() { jpeg_destroy_decompress(&info); }

 private:
  static JpegDecoder& self(j_common_ptr common) {
    return *static_cast<JpegDecoder*>(common->client_data);
  }
  [[noreturn]] void leave() {
    errors.format_message(reinterpret_cast<j_common_ptr>(&info), message);
    const int code = errors.msg_code;
    is_unsupported = code == JERR_ARITH_NOTIMPL || code == JERR_BAD_PRECISION ||
                     code == JERR_COMPONENT_COUNT || code == JERR_CONVERSION_NOTIMPL ||
                     code == JERR_SOF_UNSUPPORTED;
    std::longjmp(escape, 1);
  }

  /// Checks scans and polls. libjpeg calls it for each row of blocks of each scan.
  void on_progress() {
    const auto scans = static_cast<std::uint64_t>(info.input_scan_number);
    if (scans > kMaxJpegScans ||
        scans * info.image_width * info.image_height > kMaxJpegScanPixels) {
      std::snprintf(message, sizeof message,
                    "scan %d of %u x %u pixels exceeds the limits of %d scans and %llu pixels in "
                    "all scans",
                    info.input_scan_number, info.image_width, info.image_height, kMaxJpegScans,
                    static_cast<unsigned long long>(kMaxJpegScanPixels));
      std::longjmp(escape, 1);
    }
    try {
      options.call_poll();
    } catch (...) {
      thrown = std::current_exception();
    }
    if (thrown) std::longjmp(escape, 1);
  }
};

// libjpeg's errors jump to the two functions below. No object with a destructor may live in them.
// They return false if decoding failed.

bool read_header(JpegDecoder& decoder, std::span<const std::uint8_t> bytes) {
  if (setjmp(decoder.escape)) return false;
  jpeg_create_decompress(&decoder.info);
  decoder.info.progress = &decoder.monitor;
  jpeg_mem_src(&decoder.info, bytes.data(), bytes.size());
  jpeg_read_header(&decoder.info, TRUE);
  const J_COLOR_SPACE space = decoder.info.jpeg_color_space;
  decoder.info.out_color_space = space == JCS_GRAYSCALE                   ? JCS_GRAYSCALE
                                 : space == JCS_CMYK || space == JCS_YCCK ? JCS_CMYK
                                                                          : JCS_RGB;
  jpeg_calc_output_dimensions(&decoder.info);
  return true;
}

/// Converts a row of inks to red, green and blue.
void convert_inks(const JSAMPLE* inks, bool is_inverted, JSAMPLE* rgb, JDIMENSION width) {
  const int full = is_inverted ? 0 : 255;
  for (JDIMENSION x = 0; x < width; ++x, inks += 4)
    for (int c = 0; c < 3; ++c)
      *rgb++ = static_cast<JSAMPLE>(
          (std::abs(full - int{inks[c]}) * std::abs(full - int{inks[3]}) + 127) / 255);
}

/// Reads the rows. `inks` holds a row of inks, if the file has them.
bool read_rows(JpegDecoder& decoder, DecodedImage& image, JSAMPLE* inks) {
  if (setjmp(decoder.escape)) return false;
  jpeg_start_decompress(&decoder.info);
  while (decoder.info.output_scanline < decoder.info.output_height) {
    JSAMPROW pixels = image.row(static_cast<int>(decoder.info.output_scanline));
    JSAMPROW row = inks != nullptr ? inks : pixels;
    jpeg_read_scanlines(&decoder.info, &row, 1);
    if (inks != nullptr)
      convert_inks(inks, decoder.info.saw_Adobe_marker, pixels, decoder.info.output_width);
  }
  jpeg_finish_decompress(&decoder.info);
  return true;
}

/// Returns the bytes of the coefficients that libjpeg stores for a file with several scans.
std::uint64_t coefficient_bytes(jpeg_decompress_struct& info) {
  if (!jpeg_has_multiple_scans(&info)) return 0;
  const auto round_up = [](std::uint64_t value, int step) {
    const auto unit = static_cast<std::uint64_t>(step);
    return (value + unit - 1) / unit * unit;
  };
  std::uint64_t blocks = 0;
  for (int i = 0; i < info.num_components; ++i) {
    const jpeg_component_info& part = info.comp_info[i];
    blocks += round_up(part.width_in_blocks, part.h_samp_factor) *
              round_up(part.height_in_blocks, part.v_samp_factor);
  }
  return blocks * sizeof(JBLOCK);
}

[[noreturn]] void fail(const JpegDecoder& decoder, const std::string& name) {
  if (decoder.thrown) std::rethrow_exception(decoder.thrown);
  throw Error(name, "",
              std::string(decoder.is_unsupported ? "this kind of JPEG file is not read: "
                                                 : "damaged JPEG file: ") +
                  decoder.message);
}

}  // namespace

bool is_jpeg(std::span<const std::uint8_t> bytes) {
  return bytes.size() >= 3 && bytes[0] == 0xFF && bytes[1] == 0xD8 && bytes[2] == 0xFF;
}

DecodedImage decode_jpeg(std::span<const std::uint8_t> bytes, const std::string& name,
                         const ImageOptions& options) {
  if (!is_jpeg(bytes)) throw Error(name, "byte 0", "not a JPEG file");
  JpegDecoder decoder(options);
  if (!read_header(decoder, bytes)) fail(decoder, name);
  jpeg_decompress_struct& info = decoder.info;
  check_image_size(name, info.output_width, info.output_height);
  const std::uint64_t work_bytes = coefficient_bytes(info) + kJpegWorkBytes;
  const MemoryReservation work(options.memory, work_bytes);
  info.mem->max_memory_to_use = static_cast<long>(work_bytes + kJpegWorkBytes);
  DecodedImage image(static_cast<int>(info.output_width), static_cast<int>(info.output_height),
                     info.out_color_space == JCS_GRAYSCALE ? 1 : 3, 1, options.memory);
  std::vector<JSAMPLE> inks;
  if (info.out_color_space == JCS_CMYK) inks.resize(4 * std::size_t{info.output_width});
  if (!read_rows(decoder, image, inks.empty() ? nullptr : inks.data())) fail(decoder, name);
  return image;
}

}  // namespace voxdag
