#pragma once
/// Reads an ESVO file.
#include <filesystem>

#include "voxdag/core/io/file_copy.hpp"
#include "voxdag/file/esvo_parse.hpp"

namespace voxdag {

/// Reads the file into memory, checks every chunk, and checks that the octree is safe to walk.
/// Views stay valid when the object is moved, and when other programs change the file (see
/// FileCopy).
class EsvoFile {
 public:
  /// Reads the file. Throws Error(path, place, reason) for a file that cannot be read or fails a
  /// check.
  explicit EsvoFile(const std::filesystem::path& path);

  const EsvoContents& contents() const { return contents_; }
  const EsvoView& view() const { return contents_.view; }
  const EsvoMetadata& metadata() const { return contents_.metadata; }
  const Grid& grid() const { return contents_.metadata.grid; }
  std::span<const EsvoBlockEntry> directory() const { return contents_.directory; }
  std::uint64_t file_bytes() const { return file_.bytes().size(); }

 private:
  FileCopy file_;
  EsvoContents contents_;
};

/// Returns whether the file is an ESVO, and false for a DAG. Reads only its chunk table. Throws
/// Error(path, place, reason) for a file that is neither.
bool is_esvo_file(const std::filesystem::path& path);

}  // namespace voxdag
