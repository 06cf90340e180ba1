#pragma once
/// A task of the filters: one subtree of a DAG, and the pieces of its triangles.
#include <algorithm>
#include <bit>
#include <span>

#include "voxdag/builders/pieces/load_pieces.hpp"
#include "voxdag/stored/attributes/numbered_cell.hpp"

namespace voxdag {

/// A cell whose subtree one thread filters in one step.
struct CellTask {
  NumberedCell cell;
  Vec3i place{};                             ///< In cells of its level.
  std::span<const std::uint32_t> triangles;  ///< Those that meet it.
};

/// Cuts the triangles of tasks into pieces, one task at a time. Each thread has its own.
class TaskPieces {
 public:
  /// The largest number of triangles that are cut into pieces at a time.
  static constexpr std::size_t kMaxLoaded = 1 << 14;

  /// Refers to the arguments. Counts the pieces in `memory`.
  TaskPieces(const SvdagView& dag, const CellIndexView& index, const TriangleSource& source,
             const PieceSampler& sampler, MemoryBudget* memory)
      : dag_(dag), index_(index), source_(source), sampler_(sampler), pieces_(memory) {}

  const PieceSampler& sampler() const { return sampler_; }

  /// Returns the bytes that the pieces of this many triangles are expected to take.
  static std::uint64_t expected_bytes(std::size_t triangles) {
    return std::min(triangles, kMaxLoaded) * PieceStack::kBytesPerTriangle;
  }

  /// Calls use(cell, pieces) for the finest cells of the task that its triangles meet, without the
  /// pieces that the alpha test of the sampler's shading removes. The cells come in the order of
  /// their numbers for each kMaxLoaded triangles. Throws OverMemory.
  template <class Use>
  void for_each_finest_cell(const CellTask& task, const Use& use) {
    for (std::size_t begin = 0; begin < task.triangles.size(); begin += kMaxLoaded) {
      const std::size_t count = std::min(kMaxLoaded, task.triangles.size() - begin);
      load_pieces(pieces_, sampler_, source_, task.cell.level, task.place,
                  task.triangles.subspan(begin, count));
      descend(task.cell, pieces_.root(), use);
    }
    pieces_.finish();
  }

 private:
  template <class Use>
  void descend(const NumberedCell& cell, StackedCell part, const Use& use) {
    if (sampler_.shading() != nullptr)
      pieces_.remove_if(part, [this](const Cell& view, const TrianglePiece& piece) {
        return sampler_.is_alpha_masked(view, piece);
      });
    if (part.is_empty()) return;
    if (cell.level == index_.finest_level) return use(cell, pieces_.view(part));
    const PieceStack::Split split = pieces_.begin_split(part);
    for (std::uint32_t left = split.children & children_of(dag_, cell); left != 0;
         left &= left - 1) {
      const int child = std::countr_zero(left);
      const StackedCell of_child = pieces_.push_child(part, split, child);
      descend(child_of(dag_, index_, cell, child), of_child, use);
      pieces_.pop(of_child);
    }
    pieces_.end_split(split);
  }

  const SvdagView& dag_;
  const CellIndexView& index_;
  const TriangleSource& source_;
  const PieceSampler sampler_;
  PieceStack pieces_;
};

}  // namespace voxdag
