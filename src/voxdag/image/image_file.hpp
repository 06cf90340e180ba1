#pragma once
/// Image files as the decoders see them, and the limits that keep hostile ones from costing more.
#include <cstdint>
#include <filesystem>
#include <span>

#include "voxdag/io/mapped_file.hpp"

namespace voxdag {

/// Larger image files are refused.
inline constexpr SizeLimit kMaxImageFile{std::uint64_t{1} << 30, "an image"};

/// Images of more pixels are refused before memory is taken for them: 16,384 x 16,384.
inline constexpr std::uint64_t kMaxImagePixels = std::uint64_t{1} << 28;

/// Maps an image file: only the pages that a decoder touches are read. Throws Error.
inline MappedFile map_image(const std::filesystem::path& path) {
  return MappedFile(path, MappedFile::Access::kSequential, kMaxImageFile);
}

/// Returns the bytes of a mapped file in the type that the decoders take.
inline std::span<const std::uint8_t> encoded_bytes(const MappedFile& file) {
  return {reinterpret_cast<const std::uint8_t*>(file.bytes().data()), file.bytes().size()};
}

}  // namespace voxdag
