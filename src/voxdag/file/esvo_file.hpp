#pragma once
/// An ESVO file opened for use.
#include <filesystem>

#include "voxdag/file/esvo_parse.hpp"
#include "voxdag/io/mapped_file.hpp"

namespace voxdag {

/// Opens by mapping the file, checks every chunk and that the octree is safe to walk, and throws
/// Error(path, place, reason) otherwise. Move-only; views stay valid when it is moved. Do not cut
/// the file short while it is open (see MappedFile).
class EsvoFile {
 public:
  explicit EsvoFile(const std::filesystem::path& path);

  const EsvoView& view() const { return contents_.view; }
  const EsvoMetadata& metadata() const { return contents_.metadata; }
  const Grid& grid() const { return contents_.metadata.grid; }
  std::span<const EsvoBlockEntry> directory() const { return contents_.directory; }
  std::uint64_t file_bytes() const { return mapping_.bytes().size(); }

 private:
  MappedFile mapping_;
  EsvoContents contents_;
};

/// Whether the file at `path` is an ESVO: false for a DAG. Looks at its chunk table only. Throws
/// Error(path, place, reason) for what is neither.
bool is_esvo_file(const std::filesystem::path& path);

}  // namespace voxdag
