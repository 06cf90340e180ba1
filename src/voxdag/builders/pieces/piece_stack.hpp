#pragma once
/// A stack of lists: the pieces of triangles in a cell, and in the cells on the current path below
/// it.
///
/// Each level of the recursion cuts the pieces of the parent cell at its middle planes. The
/// children that a triangle meets are computed exactly (see "Exact cover" in the design); the
/// polygons only approximate its shape.
#include <algorithm>
#include <cstdint>

#include "voxdag/builders/pieces/cell.hpp"
#include "voxdag/builders/pieces/child_triangles.hpp"
#include "voxdag/builders/voxelize/cell_classify.hpp"
#include "voxdag/core/memory_budget.hpp"

namespace voxdag {

/// Refers to a cell whose pieces are on a PieceStack. Stays valid while lists are pushed and popped
/// above it.
struct StackedCell {
  int log2_size = 0;
  Vec3i origin{};                  ///< In the coordinates of the triangles, in voxels.
  std::size_t begin = 0, end = 0;  ///< Its pieces.

  bool is_empty() const { return begin == end; }
};

class PieceStack {
 public:
  /// Counts its memory in `budget`. Functions that add throw OverMemory.
  explicit PieceStack(MemoryBudget* budget = nullptr);

  /// The children that the pieces of a cell meet.
  struct Split {
    std::uint32_t children = 0;  ///< Bit mask of the children that some piece meets.
    std::size_t first = 0;       ///< First index in `classified_`.
  };

  /// The bytes that a cell and the cells below it take for each triangle of the cell.
  static constexpr std::uint64_t kBytesPerTriangle =
      sizeof(SurfaceTriangle) + 2 * (sizeof(TrianglePiece) + sizeof(ChildConditions));

  /// Removes all triangles and begins a cell of 2^log2_size voxels a side at `origin` in the grid,
  /// in voxels. `triangles` is the expected number of triangles.
  void start(int log2_size, Vec3i origin, std::size_t triangles);
  /// Removes all triangles. Keeps the memory for the next cell, because new memory would fault its
  /// pages again. Frees it if all threads together could hold more than 1/16 of the budget.
  void finish();
  /// Adds a triangle, whose coordinates are relative to the cell's origin. The caller chooses `id`.
  void add(const SurfaceTriangle& triangle, std::uint32_t id);

  /// Returns the cell that start() began.
  StackedCell root() const { return {log2_size_, {}, 0, pieces_.size()}; }
  Cell view(const StackedCell& cell) const {
    return {cell.log2_size, cell.origin, origin_, triangles_,
            std::span(pieces_).subspan(cell.begin, cell.end - cell.begin)};
  }

  /// Returns the area of the root's surface in voxels² plus the number of triangles.
  double weight() const;
  /// Lists the ids of the triangles that meet each child of the root.
  void list_children(ChildTriangles& children) const;

  /// Removes the pieces of the topmost cell for which `is_removed(view, piece)` is true.
  template <class Predicate>
  void remove_if(StackedCell& cell, const Predicate& is_removed) {
    const Cell cell_view = view(cell);
    const auto first = pieces_.begin() + static_cast<std::ptrdiff_t>(cell.begin);
    pieces_.erase(
        std::remove_if(first, pieces_.end(),
                       [&](const TrianglePiece& piece) { return is_removed(cell_view, piece); }),
        pieces_.end());
    cell.end = pieces_.size();
  }

  /// Classifies the pieces of the topmost cell. Each begin_split() needs an end_split().
  Split begin_split(const StackedCell& cell);
  void end_split(const Split& split) { classified_.resize(split.first); }
  /// Pushes the pieces of `cell` that lie in child `child`, and returns the child.
  StackedCell push_child(const StackedCell& cell, const Split& split, int child);
  /// Removes the pieces of the child that push_child() pushed last.
  void pop(const StackedCell& child) { pieces_.resize(child.begin); }

 private:
  std::uint64_t held_bytes() const;
  ChildConditions classify(const TrianglePiece& piece, int log2_size, Vec3i origin) const;
  void push_part(std::size_t of, const ChildConditions& classified, int child);
  void set_area(TrianglePiece& piece) const;

  /// The most bytes that the stack of each thread may hold between two cells.
  std::uint64_t most_kept_bytes_ = ~std::uint64_t{0};
  int log2_size_ = 0;
  Vec3i origin_{};
  CountedVector<SurfaceTriangle> triangles_;
  CountedVector<std::uint32_t> ids_;
  CountedVector<TrianglePiece> pieces_;
  CountedVector<ChildConditions> classified_;  // per piece of the cells that are being split
};

}  // namespace voxdag
