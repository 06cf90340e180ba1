#pragma once
/// Input files that readers can map: compressed ones and pipes are unpacked to memory first.
#include <filesystem>
#include <optional>

#include "voxdag/core/io/descriptor.hpp"
#include "voxdag/core/parallel/work.hpp"

namespace voxdag {

/// A file that a user names. Its bytes can be opened at path() any number of times while this
/// object lives. Move-only.
///
/// Files that begin with the magic bytes of gzip or Zstandard are unpacked to memory. So are "-",
/// the standard input, and other pipes that this process holds open, such as /dev/fd/63: each of
/// them is read once, by the first InputFile, and kept until the process ends. The budget of `work`
/// counts the unpacked bytes.
class InputFile {
 public:
  /// Throws the errors of open_input(), Error(given, byte, reason) if compressed data are damaged,
  /// OverMemory with the file's name, and Cancelled.
  explicit InputFile(const std::filesystem::path& given, Work work = {});

  /// Returns the path that opens the bytes. Errors should name the file as it was given.
  const std::filesystem::path& path() const { return path_; }
  /// Returns the given name; of a compressed file its unpacked_name(). Its ending tells the format.
  const std::filesystem::path& name() const { return name_; }
  /// Returns whether path() differs from the given path.
  bool is_in_memory() const { return is_in_memory_; }

 private:
  std::filesystem::path path_, name_;
  bool is_in_memory_ = false;
  Descriptor memory_;
  MemoryReservation reservation_;
};

}  // namespace voxdag
