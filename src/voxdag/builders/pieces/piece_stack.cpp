#include "voxdag/builders/pieces/piece_stack.hpp"

#include <algorithm>
#include <bit>

#include "voxdag/core/morton.hpp"
#include "voxdag/core/parallel/thread_count.hpp"

namespace voxdag {

PieceStack::PieceStack(MemoryBudget* budget)
    : triangles_(budget), ids_(budget), pieces_(budget), classified_(budget) {
  if (budget == nullptr || budget->limit() == 0) return;
  const auto threads = thread_count();
  most_kept_bytes_ = budget->limit() / 16 / threads;
}

void PieceStack::start(int log2_size, Vec3i origin, std::size_t triangles) {
  log2_size_ = log2_size;
  origin_ = origin;
  triangles_.clear();
  ids_.clear();
  pieces_.clear();
  triangles_.reserve(triangles);
  ids_.reserve(triangles);
  pieces_.reserve(triangles);
}

/// Returns the bytes that the stack holds, also if it is empty.
std::uint64_t PieceStack::held_bytes() const {
  return triangles_.capacity() * sizeof(SurfaceTriangle) + ids_.capacity() * sizeof(std::uint32_t) +
         pieces_.capacity() * sizeof(TrianglePiece) +
         classified_.capacity() * sizeof(ChildConditions);
}

void PieceStack::finish() {
  triangles_.clear();
  ids_.clear();
  pieces_.clear();
  if (held_bytes() <= most_kept_bytes_) return;
  triangles_ = CountedVector<SurfaceTriangle>(triangles_.get_allocator());
  ids_ = CountedVector<std::uint32_t>(ids_.get_allocator());
  pieces_ = CountedVector<TrianglePiece>(pieces_.get_allocator());
  classified_ = CountedVector<ChildConditions>(classified_.get_allocator());
}

void PieceStack::add(const SurfaceTriangle& triangle, std::uint32_t id) {
  const auto index = static_cast<std::uint32_t>(triangles_.size());
  triangles_.push_back(triangle);
  ids_.push_back(id);
  pieces_.emplace_back();
  TrianglePiece& piece = pieces_.back();
  piece.triangle = index;
  piece.conditions = triangle.setup.conditions;
  piece.polygon = triangle.polygon({}, log2_size_);
  piece.polygon.clip_to_cell();
  set_area(piece);
}

void PieceStack::set_area(TrianglePiece& piece) const {
  piece.area = std::max(dot(piece.polygon.area(), triangles_[piece.triangle].normal), 0.0);
}

double PieceStack::weight() const {
  const Cell cell = view(root());
  double weight = 0;
  for (const TrianglePiece& piece : cell.pieces) weight += 1 + cell.area(piece);
  return weight;
}

void PieceStack::list_children(ChildTriangles& children) const {
  for (auto& child : children) child.clear();
  for (const TrianglePiece& piece : pieces_) {
    const ChildConditions classified = classify(piece, log2_size_, {});
    for (std::uint32_t left = classified.alive; left != 0; left &= left - 1)
      children[static_cast<std::size_t>(std::countr_zero(left))].push_back(ids_[piece.triangle]);
  }
}

ChildConditions PieceStack::classify(const TrianglePiece& piece, int log2_size,
                                     Vec3i origin) const {
  const auto meets = [&](std::uint32_t first, std::uint32_t last) -> ChildConditions {
    const std::uint64_t every = piece.conditions * detail::kEveryLane;
    return {1u << first | 1u << last, {every, every}};
  };
  if (const auto octants = piece.polygon.octants()) return meets(octants->first, octants->last);
  // If the triangle's box lies in one child, or in two neighbouring ones, the triangle meets them.
  const TriangleSetup& setup = triangles_[piece.triangle].setup;
  const int shift = log2_size - 1;
  std::uint32_t lo = 0, hi = 0;
  bool is_inside = true;
  for (int axis = 0; axis < 3; ++axis) {
    const int from = (setup.box_lo[axis] - origin[axis]) >> shift;
    const int to = (setup.box_hi[axis] - origin[axis]) >> shift;
    is_inside &= ((from | to) & ~1) == 0;
    lo |= static_cast<std::uint32_t>(from) << axis;
    hi |= static_cast<std::uint32_t>(to) << axis;
  }
  const std::uint32_t across = lo ^ hi;
  if (is_inside && (across & (across - 1)) == 0) return meets(lo, hi);
  return classify_children(setup, piece.conditions, origin, 1 << shift);
}

PieceStack::Split PieceStack::begin_split(const StackedCell& cell) {
  Split split{0, classified_.size()};
  for (std::size_t i = cell.begin; i < cell.end; ++i) {
    classified_.push_back(classify(pieces_[i], cell.log2_size, cell.origin));
    split.children |= classified_.back().alive;
  }
  return split;
}

StackedCell PieceStack::push_child(const StackedCell& cell, const Split& split, int child) {
  const int log2_half = cell.log2_size - 1;
  StackedCell part{log2_half, cell.origin + child_offset(child) * (1 << log2_half), pieces_.size(),
                   0};
  for (std::size_t i = cell.begin; i < cell.end; ++i) {
    const ChildConditions& classified = classified_[split.first + (i - cell.begin)];
    if ((classified.alive >> child & 1u) != 0) push_part(i, classified, child);
  }
  part.end = pieces_.size();
  return part;
}

void PieceStack::push_part(std::size_t of, const ChildConditions& classified, int child) {
  pieces_.emplace_back();
  const TrianglePiece& whole = pieces_[of];
  TrianglePiece& part = pieces_.back();
  part.triangle = whole.triangle;
  part.conditions = classified.conditions(child);
  if ((classified.alive & (classified.alive - 1)) == 0) {
    part.polygon.become_enlarged(whole.polygon, child);
    part.area = 4 * whole.area;
    return;
  }
  std::uint32_t across = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const std::uint32_t low = detail::kLowChildren[axis];
    if ((classified.alive & low) != 0 && (classified.alive & ~low) != 0) across |= 1u << axis;
  }
  part.polygon.become_octant(whole.polygon, child, across);
  set_area(part);
}

}  // namespace voxdag
