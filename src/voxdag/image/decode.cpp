#include "voxdag/image/decode.hpp"

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/image/image_limits.hpp"
#include "voxdag/image/jpeg.hpp"
#include "voxdag/image/png.hpp"

namespace voxdag {

DecodedImage decode_image(std::span<const std::uint8_t> bytes, const std::string& name,
                          const ImageOptions& options) {
  if (bytes.empty()) throw Error(name, "", "the image is empty");
  try {
    if (is_png(bytes)) return decode_png(bytes, name, options);
    if (is_jpeg(bytes)) return decode_jpeg(bytes, name, options);
  } catch (const OverMemory& error) {
    throw OverMemory(name, error.place(), error.reason());
  }
  throw Error(name, "byte 0", "neither a PNG nor a JPEG image");
}

DecodedImage read_image(const std::filesystem::path& path, const ImageOptions& options) {
  const MappedFile file(path, MappedFile::Access::kSequential, kMaxImageFile);
  const std::string_view text = file.text();
  return decode_image({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()},
                      path.string(), options);
}

}  // namespace voxdag
