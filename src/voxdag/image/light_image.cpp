#include "voxdag/image/light_image.hpp"

#include <algorithm>
#include <cmath>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/image/exr.hpp"
#include "voxdag/image/image_limits.hpp"
#include "voxdag/image/stb_formats.hpp"

namespace voxdag {

ImageF read_light_image(const std::filesystem::path& path) {
  const MappedFile file(path, MappedFile::Access::kSequential, kMaxImageFile);
  const std::string_view text = file.text();
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  const bool is_exr = text.starts_with("v/1\x01");
  if (!is_exr && !text.starts_with("#?"))
    throw Error(path.string(), "byte 0", "neither a Radiance HDR nor an OpenEXR image");
  ImageF image = is_exr ? decode_exr(bytes, path.string()) : decode_hdr(bytes, path.string());
  constexpr float kMost = 65504;  // of a half: brighter suns become infinite in files of halves
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    float& value = image.pixels[i];
    if (std::isnan(value)) {
      const auto pixel = i / 3, width = static_cast<std::size_t>(image.width);
      throw Error(path.string(),
                  "pixel " + std::to_string(pixel % width) + "," + std::to_string(pixel / width),
                  "is not a number");
    }
    value = std::isinf(value) && value > 0 ? kMost : std::max(value, 0.0f);
  }
  return image;
}

}  // namespace voxdag
