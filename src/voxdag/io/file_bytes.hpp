#pragma once
/// Whole files as bytes: the codecs work in memory, so that only this file meets the disk.
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace voxdag {

/// Throws Error if the file cannot be opened or read to its end.
std::vector<std::uint8_t> read_image_bytes(const std::filesystem::path& path);

/// Through AtomicFile: complete or not at all. Throws Error.
void write_image_bytes(const std::filesystem::path& path, std::span<const std::uint8_t> bytes);

}  // namespace voxdag
