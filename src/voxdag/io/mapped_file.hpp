#pragma once
/// A file mapped into memory for reading.
#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

#include "voxdag/io/open_input.hpp"

namespace voxdag {

/// A regular file's bytes, read by the system when they are first touched. Move-only; the bytes
/// stay at their address when it is moved.
///
/// A process that reads a page of a mapping whose file another process has cut short gets SIGBUS.
/// Files that are replaced by renaming, as AtomicFile does, are safe; files edited in place are
/// not.
class MappedFile {
 public:
  /// How the bytes will be read: a hint for the system's read-ahead.
  enum class Access {
    kSequential,  ///< Once, from the first byte to the last.
    kSoon,        ///< All of it, soon, in any order.
    kRandom       ///< Parts of it.
  };

  /// Throws the errors of open_input, and "cannot map: ...".
  explicit MappedFile(const std::filesystem::path& path, Access access = Access::kSoon,
                      SizeLimit limit = {});
  MappedFile(MappedFile&& other) noexcept;
  MappedFile& operator=(MappedFile&& other) noexcept;
  ~MappedFile();

  /// Aligned to a page; empty for an empty file.
  std::span<const std::byte> bytes() const { return bytes_; }
  std::string_view text() const {
    return {reinterpret_cast<const char*>(bytes_.data()), bytes_.size()};
  }

  /// Drops the resident pages that lie wholly inside `part` of the bytes: they no longer count as
  /// this process's memory. The system reads them again when they are touched again. Thread-safe.
  void release(std::string_view part) const;

 private:
  std::span<const std::byte> bytes_;
};

}  // namespace voxdag
