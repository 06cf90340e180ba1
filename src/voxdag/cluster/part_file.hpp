#pragma once
/// The DAGs of a part: a file of one or more pieces.
///
/// A part whose build needs too much memory is built in pieces: smaller runs of cells. Each piece
/// is a minimal DAG of the whole grid that has no voxels elsewhere.
///
///   for each piece: PieceHeader, u32 nodes[], zeros up to a multiple of 8, u64 leaf_blocks[]
#include <cstdint>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "voxdag/builders/voxelize/cell_range.hpp"
#include "voxdag/cluster/work_folder.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// A piece that was read. The view points into its file.
struct PartPiece {
  CellRange range;
  SvdagView dag;
};

/// Appends a piece. Throws Error.
void write_piece(WorkFileWriter& file, const CellRange& range, const SvdagView& dag);

/// A part that was read.
struct PartFile {
  WorkFile file;
  std::vector<PartPiece> pieces;

  /// Drops the pages of the file from memory.
  void release() const { file.release(file.bytes().size()); }
};

/// The parts of a job. Opens and checks each when it is first needed, and keeps it mapped.
/// Thread-safe.
class PartFiles {
 public:
  /// Refers to `folder`.
  PartFiles(const WorkFolder& folder, std::uint64_t count, Work work)
      : folder_(folder), count_(count), work_(work) {}

  std::uint64_t count() const { return count_; }
  /// Throws Error if the part is missing or damaged, and Cancelled.
  const PartFile& get(std::uint64_t part);

 private:
  const WorkFolder& folder_;
  std::uint64_t count_;
  Work work_;
  std::mutex mutex_;
  std::map<std::uint64_t, PartFile> open_;
};

/// Returns the name of the file of a part.
std::string part_name(std::uint64_t part);

}  // namespace voxdag
