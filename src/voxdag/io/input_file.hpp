#pragma once
/// A file mapped for reading, whose pages can be let go as soon as they are read.
#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace voxdag {

/// Read-only view of a regular file. The file must not be shortened by others while it is mapped.
class InputFile {
 public:
  /// Throws Error if the path does not exist, is no regular file, or may not be read.
  explicit InputFile(const std::filesystem::path& path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  std::string_view bytes() const { return {data_, size_}; }

  /// Drops the resident pages that lie wholly inside `part` of bytes(): they no longer count as
  /// this process's memory and are mapped again if they are read again. Thread-safe.
  void release(std::string_view part) const;

 private:
  const char* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace voxdag
