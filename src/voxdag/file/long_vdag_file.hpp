#pragma once
/// Reads a DAG with long pointers from a .vdag file.
#include <filesystem>

#include "voxdag/file/vdag_container.hpp"

namespace voxdag {

/// A mapped file: the DAG can be larger than memory. Checks every chunk, and that the DAG is safe
/// to walk. The view stays valid when the object is moved. No other process may change the file
/// while it is used, because the checks are done once.
class LongVdagFile {
 public:
  /// Maps the file. Throws Error(path, place, reason).
  explicit LongVdagFile(const std::filesystem::path& path) : LongVdagFile(VdagContainer(path)) {}
  /// Shares the bytes of an open file.
  explicit LongVdagFile(VdagContainer file);

  const LongSvdagView& view() const { return view_; }
  const VdagMetadata& metadata() const { return metadata_; }
  std::uint64_t file_bytes() const { return file_.bytes().size(); }

 private:
  VdagContainer file_;
  VdagMetadata metadata_;
  LongSvdagView view_;
};

}  // namespace voxdag
