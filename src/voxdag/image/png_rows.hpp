#pragma once
/// Writes PNG files row by row, using libpng.
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

namespace voxdag {

enum class PngPixels {
  kBits,  ///< One bit each, 1 is white: 8 pixels a byte, the first in the highest bit.
  kRgba,  ///< Four bytes each, sRGB encoded.
};

/// The file appears at its path when it is complete.
class PngRowWriter {
 public:
  /// Throws Error if the file cannot be written or libpng does not write pictures of this size.
  PngRowWriter(const std::filesystem::path& path, std::uint32_t width, std::uint32_t height,
               PngPixels pixels);
  ~PngRowWriter();
  PngRowWriter(const PngRowWriter&) = delete;
  PngRowWriter& operator=(const PngRowWriter&) = delete;

  /// Writes the next row, from the top: (width + 7) / 8 or 4 * width bytes. Throws Error.
  void write(std::span<const std::uint8_t> row);
  /// Completes the file after `height` rows. Throws Error.
  void commit();

 private:
  struct Encoder;
  std::unique_ptr<Encoder> encoder_;
};

}  // namespace voxdag
