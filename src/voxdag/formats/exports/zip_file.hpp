#pragma once
/// Writes ZIP archives, through minizip.
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string_view>

namespace voxdag {

/// The archive appears at its path when it is complete. Equal content makes equal archives: all
/// files in it have the date 1980-01-01. The output must be seekable.
class ZipFile {
 public:
  /// Throws Error if the archive cannot be created.
  explicit ZipFile(const std::filesystem::path& path);
  ~ZipFile();
  ZipFile(const ZipFile&) = delete;
  ZipFile& operator=(const ZipFile&) = delete;

  /// Ends the file before, and begins another one of up to `most_bytes`. From 4 GiB on, it takes
  /// the form (ZIP64) that old programs cannot read. Throws Error, as write() and commit().
  void begin(const char* name, std::uint64_t most_bytes = 0);
  void write(std::string_view bytes);
  void commit();

 private:
  struct Archive;
  std::unique_ptr<Archive> archive_;
};

}  // namespace voxdag
