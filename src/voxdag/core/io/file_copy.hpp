#pragma once
/// A file's bytes, copied into this process's memory.
#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>

#include "voxdag/core/io/open_input.hpp"

namespace voxdag {

/// A copy of a regular file, read once. Unlike a mapping, it does not change when other programs
/// rewrite or truncate the file, so bytes that a reader has checked stay valid. Memory: the bytes
/// of the file, on large pages if the system grants them. Copies of this object share the bytes.
class FileCopy {
 public:
  /// Copies the file to memory. Throws the errors of open_input, std::bad_alloc, and
  /// Error(path, place, reason) if the file cannot be read or is truncated during the read.
  explicit FileCopy(const std::filesystem::path& path, SizeLimit limit = {});
  /// Copies a file that open_input() has opened, from its first byte. `path` is for errors.
  FileCopy(const OpenInput& input, const std::filesystem::path& path);

  /// Returns the bytes, aligned to at least 64; none for an empty file.
  std::span<const std::byte> bytes() const { return {bytes_.get(), size_}; }

 private:
  std::shared_ptr<std::byte[]> bytes_;
  std::size_t size_ = 0;
};

}  // namespace voxdag
