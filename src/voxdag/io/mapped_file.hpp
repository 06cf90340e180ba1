#pragma once
/// A file mapped into memory for reading.
#include <cstddef>
#include <filesystem>
#include <span>

namespace voxdag {

/// Move-only; the bytes stay where they are when it is moved. Throws Error if the file cannot be
/// opened or is not a regular file. A process that reads a page of a mapping whose file another
/// one has since cut short gets SIGBUS: files that are replaced by renaming, as AtomicFile does,
/// are safe, files edited in place are not.
class MappedFile {
 public:
  explicit MappedFile(const std::filesystem::path& path);
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;
  ~MappedFile();

  /// Aligned to a page; empty for an empty file.
  std::span<const std::byte> bytes() const { return bytes_; }

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace voxdag
