#include "voxdag/builders/attributes/material_cells.hpp"

#include <algorithm>
#include <bit>
#include <cassert>

namespace voxdag {
namespace {

constexpr double kTouchArea = 1e-6;  ///< Added to the area of every piece.

bool has_less_id(const MaterialArea& a, const MaterialArea& b) { return a.id < b.id; }

/// Merges the areas [begin, from) and [from, end) of a vector. Both are sorted, and so is the
/// result.
void merge_from(MaterialAreas& areas, std::size_t begin, std::size_t from) {
  if (begin == from) return;
  const auto at = [&](std::size_t i) { return areas.begin() + static_cast<std::ptrdiff_t>(i); };
  std::inplace_merge(at(begin), at(from), areas.end(), has_less_id);
  std::size_t last = begin;
  for (std::size_t i = begin + 1; i < areas.size(); ++i) {
    if (areas[i].id == areas[last].id)
      areas[last].area += areas[i].area;
    else
      areas[++last] = areas[i];
  }
  areas.resize(last + 1);
}

}  // namespace

std::uint32_t largest_material(std::span<const MaterialArea> areas) {
  assert(!areas.empty());
  double largest = 0;
  for (const MaterialArea& of : areas) largest = std::max(largest, of.area);
  for (const MaterialArea& of : areas)
    if (of.area >= largest * (1 - kEqualAreas)) return of.id;
  return areas.front().id;
}

void add_areas(MaterialAreas& to, const MaterialAreas& from) {
  const std::size_t middle = to.size();
  to.insert(to.end(), from.begin(), from.end());
  if (!from.empty()) merge_from(to, 0, middle);
}

MaterialFilter::MaterialFilter(const SvdagView& dag, const CellIndexView& index,
                               const TriangleSource& source,
                               std::span<const std::uint32_t> materials, MemoryBudget* memory)
    : dag_(dag),
      index_(index),
      materials_(materials),
      pieces_(dag, index, source, PieceSampler(nullptr), memory),
      entries_(memory) {}

MaterialAreas MaterialFilter::filter(const CellTask& task, std::vector<CellRun>& runs) {
  first_ = task.cell.number;
  entries_.clear();
  pieces_.for_each_finest_cell(task, [this](const NumberedCell& cell, const Cell& pieces) {
    add_entries(static_cast<std::uint32_t>(cell.number - first_), pieces);
  });
  // One batch of triangles gives sorted entries. Equal entries stay in the order of the batches.
  if (task.triangles.size() > TaskPieces::kMaxLoaded)
    std::stable_sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
      return a.cell != b.cell ? a.cell < b.cell : a.id < b.id;
    });
  ids_.assign(cells_in(dag_, index_, task.cell), 0);
  next_ = 0;
  stack_.clear();
  join(task.cell);
  entries_ = CountedVector<Entry>(entries_.get_allocator());  // counted only until this task ends
  runs.clear();
  for (const std::uint16_t id : ids_) {
    if (runs.empty() || runs.back().id != id) runs.push_back({id, 0});
    ++runs.back().length;
  }
  return stack_;
}

/// Adds the areas of the pieces in a cell of the finest level, which has the number first_ + cell.
void MaterialFilter::add_entries(std::uint32_t cell, const Cell& pieces) {
  const std::size_t begin = entries_.size();
  for (const TrianglePiece& piece : pieces.pieces) {
    const std::uint32_t id = materials_[pieces.triangle_of(piece).source];
    const double area = pieces.area(piece) + kTouchArea;
    const auto at =
        std::lower_bound(entries_.begin() + static_cast<std::ptrdiff_t>(begin), entries_.end(), id,
                         [](const Entry& entry, std::uint32_t of) { return entry.id < of; });
    if (at != entries_.end() && at->id == id)
      at->area += area;
    else
      entries_.insert(at, {cell, id, area});
  }
}

/// Appends the areas in a cell to the stack, from those of its children. Sets the ids of its
/// subtree.
void MaterialFilter::join(const NumberedCell& cell) {
  const std::size_t begin = stack_.size();
  const auto number = static_cast<std::uint32_t>(cell.number - first_);
  if (cell.level == index_.finest_level) {
    for (; next_ < entries_.size() && entries_[next_].cell == number; ++next_) {
      const Entry& entry = entries_[next_];
      if (stack_.size() > begin && stack_.back().id == entry.id)
        stack_.back().area += entry.area;
      else
        stack_.push_back({entry.id, entry.area});
    }
  } else {
    for (std::uint32_t left = children_of(dag_, cell); left != 0; left &= left - 1) {
      const std::size_t from = stack_.size();
      join(child_of(dag_, index_, cell, std::countr_zero(left)));
      if (from == begin + 1 && stack_.size() == from + 1 && stack_[begin].id == stack_[from].id) {
        stack_[begin].area += stack_[from].area;  // the usual case
        stack_.pop_back();
      } else {
        merge_from(stack_, begin, from);
      }
    }
  }
  if (stack_.size() > begin)
    ids_[number] = static_cast<std::uint16_t>(largest_material(std::span(stack_).subspan(begin)));
}

}  // namespace voxdag
