#pragma once
/// Reads a DAG from a .vdag file.
#include <filesystem>

#include "voxdag/file/vdag_container.hpp"

namespace voxdag {

/// Reads the file into memory, checks every chunk, and checks that the DAG is safe to walk. Does
/// not check canonical order, minimality and the counts; verify_vdag() does. Views stay valid when
/// the object is moved, and when other programs change the file (see VdagContainer).
class VdagFile {
 public:
  /// Reads the file. Throws Error(path, place, reason) for a file that cannot be read or fails a
  /// check.
  explicit VdagFile(const std::filesystem::path& path) : VdagFile(VdagContainer(path)) {}
  /// Shares the bytes of an open file.
  explicit VdagFile(VdagContainer file);

  const SvdagView& view() const { return contents_.view; }
  const DagAttributesView& attributes() const { return contents_.attributes; }
  const VdagMetadata& metadata() const { return contents_.metadata; }
  const Grid& grid() const { return contents_.metadata.grid; }
  const std::vector<VdagChunk>& chunks() const { return contents_.chunks; }
  std::uint64_t file_bytes() const { return file_.bytes().size(); }

 private:
  VdagContainer file_;
  VdagContents contents_;
};

}  // namespace voxdag
