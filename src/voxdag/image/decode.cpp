#include "voxdag/image/decode.hpp"

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/mapped_file.hpp"
#include "voxdag/image/image_limits.hpp"
#include "voxdag/image/jpeg.hpp"
#include "voxdag/image/png.hpp"
#include "voxdag/image/stb_formats.hpp"
#include "voxdag/image/webp.hpp"

namespace voxdag {
namespace {

/// The beginnings of image files that are not read.
struct Signature {
  std::string_view bytes, kind;
};
constexpr Signature kOthers[] = {
    {"GIF8", "a GIF image"},
    {"DDS ", "a DDS texture"},
    {"II*\0", "a TIFF image"},
    {"MM\0*", "a TIFF image"},
    {"\xABKTX", "a KTX texture"},
    {"8BPS", "a Photoshop image"},
    {"v/1\x01", "an OpenEXR image"},
    {"#?RADIANCE", "a Radiance image"},
    {"<svg", "an SVG drawing"},
    {"<?xml", "an XML file"},
    {"<!DOCTYPE", "a web page"},
    {"<html", "a web page"},
    {"version https://git-lfs", "a pointer of Git LFS, not the image"}};

/// Returns what an image file is that is not read; empty: unknown.
std::string_view other_kind(std::string_view bytes) {
  for (const Signature& other : kOthers)
    if (bytes.starts_with(other.bytes)) return other.kind;
  return bytes.substr(0, 12).ends_with("ftypavif") ? "an AVIF image" : "";
}

}  // namespace

DecodedImage decode_image(std::span<const std::uint8_t> bytes, const std::string& name,
                          const ImageOptions& options) {
  if (bytes.empty()) throw Error(name, "", "the image is empty");
  try {
    if (is_png(bytes)) return decode_png(bytes, name, options);
    if (is_jpeg(bytes)) return decode_jpeg(bytes, name, options);
    if (is_webp(bytes)) return decode_webp(bytes, name, options);
    if (auto image = decode_tga_or_bmp(bytes, name, options)) return std::move(*image);
  } catch (const OverMemory& error) {
    throw OverMemory(name, error.place(), error.reason());
  }
  const std::string_view kind =
      other_kind({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  throw Error(name, "byte 0",
              (kind.empty() ? "not an image" : std::string(kind)) +
                  ": PNG, JPEG, WebP, BMP and TGA images are read");
}

DecodedImage read_image(const std::filesystem::path& path, const ImageOptions& options) {
  const MappedFile file(path, MappedFile::Access::kSequential, kMaxImageFile);
  const std::string_view text = file.text();
  return decode_image({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()},
                      path.string(), options);
}

}  // namespace voxdag
