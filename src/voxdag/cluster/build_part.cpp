#include "voxdag/cluster/build_part.hpp"

#include <algorithm>

#include "voxdag/algebra/combine.hpp"
#include "voxdag/builders/dag/build_methods.hpp"
#include "voxdag/cluster/part_file.hpp"

namespace voxdag {
namespace {

/// The finest level whose cells can be pieces.
constexpr int kFinestPieces = 10;

class PartBuilder {
 public:
  PartBuilder(std::span<const TriangleSegment> segments, int levels, WorkFileWriter& file,
              Work work)
      : segments_(segments),
        levels_(levels),
        cell_level_(segment_cell_level(levels)),
        file_(file),
        work_(work) {}

  /// Builds a range, or halves of it if there is too little memory.
  void build(const CellRange& range) {
    try {
      return write(range);
    } catch (const OverMemory&) {
      if (range.last - range.first == 1 &&
          range.level >= std::min(kFinestPieces, levels_ - kMinLevels))
        throw;
    }
    const CellRange whole = range.last - range.first > 1
                                ? range
                                : CellRange{range.level + 1, range.first << 3, range.last << 3};
    const std::uint32_t middle = whole.first + (whole.last - whole.first) / 2;
    build({whole.level, whole.first, middle});
    build({whole.level, middle, whole.last});
  }

  const PartCounts& counts() const { return counts_; }

 private:
  /// The position in the triangles of a range.
  struct Position {
    std::size_t segment = 0;
    std::uint64_t passed = 0;
  };

  void write(const CellRange& range) {
    Position position;
    std::uint64_t triangles = 0;
    Svdag dag = build_batch(range, position, triangles);
    MemoryReservation held(work_.memory, dag.view().bytes());
    while (position.segment < segments_.size()) {
      const Svdag more = build_batch(range, position, triangles);
      const MemoryReservation more_held(work_.memory, more.view().bytes());
      Svdag both = combine(dag.view(), more.view(), SetOperation::kUnion, work_);
      dag = std::move(both);
      held.resize(dag.view().bytes());
    }
    counts_.triangles += triangles;
    if (dag.view().is_empty()) return;
    ++counts_.pieces;
    write_piece(file_, range, dag.view());
  }

  /// Builds the DAG of the triangles from `position` on, as many as fit, and moves `position` on.
  Svdag build_batch(const CellRange& range, Position& position, std::uint64_t& triangles) {
    // A triangle, the table of duplicates and its lists. The DAG takes the rest.
    constexpr std::uint64_t kBytes = 120;
    const std::uint64_t most =
        std::clamp<std::uint64_t>(work_.memory->left() / 3 / kBytes, 1024, std::uint64_t{1} << 26);
    CountedVector<QuantizedTriangle> batch{CountedAllocator<QuantizedTriangle>(work_.memory)};
    std::uint64_t entries = 0;
    for (std::size_t s = position.segment; s < segments_.size() && entries < most; ++s)
      entries += segments_[s].entries_in(range, cell_level_);
    batch.reserve(std::min(entries, most));
    while (position.segment < segments_.size() && batch.size() < most) {
      const TriangleSegment::Taken taken = segments_[position.segment].take(
          range, cell_level_, position.passed, most, batch, work_.memory);
      position.passed = taken.passed;
      if (taken.is_all) position = {position.segment + 1, 0};
    }
    triangles += batch.size();
    return build_range(std::move(batch), levels_, range, work_);
  }

  std::span<const TriangleSegment> segments_;
  int levels_, cell_level_;
  WorkFileWriter& file_;
  Work work_;
  PartCounts counts_;
};

}  // namespace

PartCounts build_part(std::span<const TriangleSegment> segments, int levels, const CellRange& range,
                      WorkFileWriter& file, Work work) {
  PartBuilder builder(segments, levels, file, work);
  builder.build(range);
  return builder.counts();
}

}  // namespace voxdag
