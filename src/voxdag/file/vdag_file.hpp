#pragma once
/// A .vdag file opened for use.
#include <filesystem>

#include "voxdag/file/vdag_parse.hpp"
#include "voxdag/io/mapped_file.hpp"

namespace voxdag {

/// Opens by mapping the file, checks every chunk and that the DAG is safe to walk, and throws
/// Error(path, place, reason) otherwise. Canonical order, minimality and the counts are left to
/// verify_vdag. Move-only; views stay valid when it is moved. Do not cut the file short while it is
/// open (see MappedFile).
class VdagFile {
 public:
  explicit VdagFile(const std::filesystem::path& path);

  const SvdagView& view() const { return contents_.view; }
  const VdagMetadata& metadata() const { return contents_.metadata; }
  const Grid& grid() const { return contents_.metadata.grid; }
  const std::vector<VdagChunk>& chunks() const { return contents_.chunks; }
  std::uint64_t file_bytes() const { return mapping_.bytes().size(); }

 private:
  MappedFile mapping_;
  VdagContents contents_;
};

}  // namespace voxdag
