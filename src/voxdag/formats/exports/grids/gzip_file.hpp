#pragma once
/// Writes gzip-compressed files, using zlib.
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string_view>

namespace voxdag {

/// The file appears at its path when it is complete. Equal content makes equal files: the header
/// has no name and no time.
class GzipFile {
 public:
  /// Throws Error if the file cannot be created.
  explicit GzipFile(const std::filesystem::path& path);
  ~GzipFile();
  GzipFile(const GzipFile&) = delete;
  GzipFile& operator=(const GzipFile&) = delete;

  /// Throws Error if the file cannot be written.
  void write(std::string_view bytes);
  void commit();

 private:
  struct Deflater;
  std::unique_ptr<Deflater> deflater_;
};

}  // namespace voxdag
