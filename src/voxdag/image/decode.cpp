#include "voxdag/image/decode.hpp"

#include "voxdag/core/error.hpp"
#include "voxdag/image/image_file.hpp"
#include "voxdag/image/jpeg.hpp"
#include "voxdag/image/png.hpp"

namespace voxdag {
namespace {

ImageRgba16 widen(const ImageRgb8& image) {
  ImageRgba16 wide(image.width, image.height);
  for (std::size_t i = 0; i < image.pixels.size() / 3; ++i) {
    for (std::size_t c = 0; c < 3; ++c)
      wide.pixels[4 * i + c] = static_cast<std::uint16_t>(image.pixels[3 * i + c] * 257);
    wide.pixels[4 * i + 3] = 65535;
  }
  return wide;
}

}  // namespace

ImageRgba16 decode_image(std::span<const std::uint8_t> bytes, const std::string& name) {
  if (bytes.empty()) throw Error(name, "", "the image is empty");
  if (bytes[0] == 0x89) return decode_png_rgba16(bytes, name);
  if (bytes[0] == 0xFF) return widen(decode_jpeg(bytes, name));
  throw Error(name, "byte 0", "neither a PNG nor a JPEG image");
}

ImageRgba16 read_image(const std::filesystem::path& path) {
  return decode_image(encoded_bytes(map_image(path)), path.string());
}

}  // namespace voxdag
