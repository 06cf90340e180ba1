#pragma once
/// A file mapped into memory for reading.
#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

#include "voxdag/core/io/open_input.hpp"

namespace voxdag {

/// A regular file's bytes, which the system reads when they are first touched. Move-only; the bytes
/// keep their address when it is moved.
///
/// If another process truncates the file, reading a page beyond its new end raises SIGBUS.
/// Replacing a file by renaming, as AtomicFile does, is safe; editing it in place is not.
class MappedFile {
 public:
  /// The order in which the bytes will be read: a hint for the system's read-ahead.
  enum class Access {
    kSequential,  ///< Once, from the first byte to the last.
    kSoon,        ///< All of it, soon, in any order.
    kRandom       ///< Parts of it.
  };

  /// Has no bytes, as an empty file.
  MappedFile() = default;
  /// Maps the file. Throws the errors of open_input, and "cannot map: ...".
  explicit MappedFile(const std::filesystem::path& path, Access access = Access::kSoon,
                      SizeLimit limit = {});
  /// Maps a file that open_input() has opened; the caller may close it. `path` is for errors.
  MappedFile(const OpenInput& input, const std::filesystem::path& path, Access access);
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;
  ~MappedFile();

  /// Returns the bytes, aligned to a page; none for an empty file.
  std::span<const std::byte> bytes() const { return bytes_; }
  std::string_view text() const {
    return {reinterpret_cast<const char*>(bytes_.data()), bytes_.size()};
  }

  /// Drops the resident pages that lie completely inside `part` of the bytes, so that they no
  /// longer count as this process's memory. The system reads them again when they are touched
  /// again. Thread-safe.
  void release(std::string_view part) const;

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace voxdag
