#pragma once
/// Reads an ESVO file.
#include <filesystem>

#include "voxdag/file/esvo_parse.hpp"
#include "voxdag/file/vdag_container.hpp"

namespace voxdag {

/// Reads the file into memory, checks every chunk, and checks that the octree is safe to walk.
/// Views stay valid when the object is moved, and when other programs change the file (see
/// VdagContainer).
class EsvoFile {
 public:
  /// Reads the file. Throws Error(path, place, reason) for a file that cannot be read or fails a
  /// check.
  explicit EsvoFile(const std::filesystem::path& path) : EsvoFile(VdagContainer(path)) {}
  /// Shares the bytes of an open file.
  explicit EsvoFile(VdagContainer file);

  const EsvoContents& contents() const { return contents_; }
  const EsvoView& view() const { return contents_.view; }
  const EsvoMetadata& metadata() const { return contents_.metadata; }
  const Grid& grid() const { return contents_.metadata.grid; }
  std::span<const EsvoBlockEntry> directory() const { return contents_.directory; }
  std::uint64_t file_bytes() const { return file_.bytes().size(); }

 private:
  VdagContainer file_;
  EsvoContents contents_;
};

}  // namespace voxdag
