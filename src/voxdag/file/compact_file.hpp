#pragma once
/// Reads a DAG in the compact form from a .vdag file.
#include <filesystem>
#include <span>
#include <vector>

#include "voxdag/file/vdag_container.hpp"
#include "voxdag/stored/attributes/stored_attributes.hpp"
#include "voxdag/stored/compact/compact_svdag.hpp"

namespace voxdag {

struct CompactContents {
  std::vector<VdagChunk> chunks;
  VdagMetadata metadata;
  CompactSvdag head;  ///< Without a stream.
  std::uint64_t head_bytes = 0;

  /// Returns the DAG. Its stream points into the bytes that were parsed.
  CompactSvdagView view() const;
  /// Returns whether the file has attributes. Then metadata.attributes.level() is their finest
  /// level, for which build_cell_index() numbers the cells of the decoded DAG.
  bool has_attributes() const;
  /// Reads and checks the attributes of the cells that `index` numbers. Those in the wire form are
  /// decoded into `expanded`. The result refers to the bytes that were parsed, to `expanded` and to
  /// the words of `index`. Linear time. Throws Error.
  DagAttributesView attributes(const CellIndexView& index, ExpandedChunks& expanded) const;
};

/// Parses the bytes of a file; vdag_parse.hpp describes the container and the rules for errors.
/// Checks everything but the contents of the stream and the attributes: any stream is safe to walk
/// and to decode, and decode_svdag() and verify find what is wrong with it.
/// CompactContents::attributes() checks the attributes.
CompactContents parse_compact(std::span<const std::byte> file);

/// Reads the file into memory and checks its checksums and its head. Views stay valid when the
/// object is moved, and when other programs change the file (see VdagContainer).
class CompactFile {
 public:
  /// Reads the file. Throws Error(path, place, reason) for a file that cannot be read or fails a
  /// check.
  explicit CompactFile(const std::filesystem::path& path) : CompactFile(VdagContainer(path)) {}
  /// Shares the bytes of an open file.
  explicit CompactFile(VdagContainer file);

  CompactSvdagView view() const { return contents_.view(); }
  const VdagMetadata& metadata() const { return contents_.metadata; }
  const Grid& grid() const { return contents_.metadata.grid; }
  const CompactContents& contents() const { return contents_; }
  std::uint64_t head_bytes() const { return contents_.head_bytes; }
  std::uint64_t file_bytes() const { return file_.bytes().size(); }

 private:
  VdagContainer file_;
  CompactContents contents_;
};

}  // namespace voxdag
