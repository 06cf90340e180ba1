#pragma once
/// Adds a shape to a DAG, removes it, and gives values to the voxels of a shape.
///
/// A cell outside of the shape keeps its node, and a cell inside becomes a full node or none, at
/// once; so the cost follows the cells that the surface of the shape cuts. If voxels are removed,
/// only cells with voxels count; if added, only cells that are not full.
///
/// Cells are visited breadth first, level by level, and joined from the finest level up: the loads
/// of all nodes of a level overlap. Large shapes are divided into cells for many threads, each of
/// which is visited in this way.
#include <algorithm>
#include <array>
#include <vector>

#include "voxdag/core/morton.hpp"
#include "voxdag/core/parallel/parallel_for.hpp"
#include "voxdag/edit/edit_nodes.hpp"
#include "voxdag/edit/edit_values.hpp"
#include "voxdag/edit/shapes.hpp"

namespace voxdag {

/// Changes the voxels of a shape.
template <class Shape>
class ShapeEdit {
 public:
  ShapeEdit(EditNodes& nodes, const Shape& shape, bool adds)
      : nodes_(nodes), shape_(shape), adds_(adds), levels_(nodes.levels()) {
    if (adds_) nodes_.add_full();
  }

  /// Returns the root after the edit. Throws what EditNodes::Writer::intern() throws.
  std::uint32_t run(std::uint32_t root) {
    std::uint32_t result = 0;
    if (is_decided(0, root, {}, result)) return result;
    EditNodes::Writer writer(nodes_);
    Frontiers upper(levels_);
    upper.start(0, root, {});
    // Divides the shape into tasks.
    int level = 0;
    while (level + kTaskLevels < levels_ - 1 && upper.at(level).size() < kTasks)
      divide(upper, level), ++level;
    std::vector<Cell>& tasks = upper.at(level);
    if (tasks.size() < kParallel) {
      Frontiers below(levels_);
      for (Cell& task : tasks) task.result = solve(writer, below, level, task);
    } else {
      parallel_for(tasks.size(), [&](std::size_t i) {
        EditNodes::Writer own(nodes_);
        Frontiers below(levels_);
        tasks[i].result = solve(own, below, level, tasks[i]);
      });
    }
    while (level-- > 0) join(writer, upper, level);
    return upper.at(0)[0].result;
  }

 private:
  /// Tasks have at least 2^(kTaskLevels + 1) voxels a side. There are up to 8 kTasks.
  static constexpr int kTaskLevels = 5;
  static constexpr std::size_t kTasks = 64, kParallel = 32;
  /// Cells of at most 2^(kBrickLevels + 1) voxels a side are visited breadth first.
  static constexpr int kBrickLevels = 4;

  /// A cell that the surface of the shape may cut.
  struct Cell {
    std::uint32_t node;
    Vec3i origin;
    std::uint32_t result = 0;
    /// For each child its result if it is decided, else the number of its cell. Bit i of `open`: it
    /// is not decided.
    std::uint32_t children[8];
    std::uint32_t open = 0;
    EditNodes::Writer::Pending pending;
  };
  /// The cells of each level.
  class Frontiers {
   public:
    explicit Frontiers(int levels) : cells_(static_cast<std::size_t>(levels)) {}
    std::vector<Cell>& at(int level) { return cells_[static_cast<std::size_t>(level)]; }
    Cell& add(int level, std::uint32_t node, Vec3i origin) {
      Cell& cell = at(level).emplace_back();
      cell.node = node;
      cell.origin = origin;
      return cell;
    }
    void start(int level, std::uint32_t node, Vec3i origin) {
      for (auto& cells : cells_) cells.clear();
      add(level, node, origin);
    }

   private:
    std::vector<std::vector<Cell>> cells_;
  };

  /// Sets `result` if the cell needs no look at its children.
  bool is_decided(int level, std::uint32_t node, Vec3i origin, std::uint32_t& result) const {
    result = node;
    if (node == (adds_ ? nodes_.full(level) : EditNodes::kNone)) return true;
    const CellPlace place = shape_.place(origin, levels_ - level);
    if (place == CellPlace::kInside) result = adds_ ? nodes_.full(level) : EditNodes::kNone;
    return place != CellPlace::kMixed;
  }

  /// Adds the children of all cells of a level that are not decided.
  void divide(Frontiers& cells, int level) {
    const std::int32_t half = std::int32_t{1} << (levels_ - level - 1);
    for (Cell& cell : cells.at(level))
      for (int i = 0; i < 8; ++i) {
        const std::uint32_t child = nodes_.child(cell.node, i);
        const Vec3i origin = cell.origin + child_offset(i) * half;
        if (is_decided(level + 1, child, origin, cell.children[i])) continue;
        cell.open |= 1u << i;
        cell.children[i] = static_cast<std::uint32_t>(cells.at(level + 1).size());
        cells.add(level + 1, child, origin);
        if (child == EditNodes::kNone) continue;
        __builtin_prefetch(level + 1 == levels_ - 2
                               ? static_cast<const void*>(nodes_.address(child))
                               : nodes_.words(child));
      }
  }

  /// Sets the results of all cells of a level from those of the level below.
  void join(EditNodes::Writer& writer, Frontiers& cells, int level) {
    for (Cell& cell : cells.at(level)) {
      bool is_changed = false;
      for (int i = 0; i < 8; ++i) {
        if ((cell.open >> i & 1) != 0)
          cell.children[i] = cells.at(level + 1)[cell.children[i]].result;
        is_changed |= cell.children[i] != nodes_.child(cell.node, i);
      }
      cell.result = cell.node;
      cell.open = is_changed ? 1 : 0;
      if (!is_changed) continue;
      cell.pending = EditNodes::Writer::node_of(cell.children);
      if (cell.pending.count != 0) writer.prefetch(level, cell.pending);
    }
    intern(writer, cells.at(level), level);
  }

  /// Looks the pending nodes of cells up: of those whose `open` is not 0.
  void intern(EditNodes::Writer& writer, std::vector<Cell>& cells, int level) {
    for (const Cell& cell : cells)
      if (cell.open != 0 && cell.pending.count != 0) writer.prefetch_found(level, cell.pending);
    for (Cell& cell : cells)
      if (cell.open != 0) cell.result = writer.intern(level, cell.pending);
  }

  void edit_blocks(EditNodes::Writer& writer, std::vector<Cell>& cells) {
    const int level = levels_ - 2;
    for (Cell& cell : cells) {
      const std::uint64_t before = cell.node == EditNodes::kNone ? 0 : nodes_.block(cell.node),
                          of_shape = shape_.block(cell.origin),
                          after = adds_ ? before | of_shape : before & ~of_shape;
      cell.result = cell.node;
      cell.open = after != before ? 1 : 0;
      if (cell.open == 0) continue;
      cell.pending = EditNodes::Writer::block_of(after);
      if (after != 0) writer.prefetch(level, cell.pending);
    }
    intern(writer, cells, level);
  }

  /// Returns the node of a cell of `level` that is not decided, after the edit.
  std::uint32_t solve(EditNodes::Writer& writer, Frontiers& cells, int level, const Cell& cell) {
    if (level < levels_ - 2 - kBrickLevels) {
      const std::int32_t half = std::int32_t{1} << (levels_ - level - 1);
      std::uint32_t children[8];
      bool is_changed = false;
      for (int i = 0; i < 8; ++i) {
        Cell child;
        child.node = nodes_.child(cell.node, i);
        child.origin = cell.origin + child_offset(i) * half;
        if (!is_decided(level + 1, child.node, child.origin, children[i]))
          children[i] = solve(writer, cells, level + 1, child);
        is_changed |= children[i] != child.node;
      }
      return is_changed ? writer.intern(level, children) : cell.node;
    }
    cells.start(level, cell.node, cell.origin);
    for (int below = level; below < levels_ - 2; ++below) divide(cells, below);
    edit_blocks(writer, cells.at(levels_ - 2));
    for (int above = levels_ - 3; above >= level; --above) join(writer, cells, above);
    return cells.at(level)[0].result;
  }

  EditNodes& nodes_;
  const Shape& shape_;
  const bool adds_;
  const int levels_;
};

/// Gives values to the cells of a shape that have voxels. A cell of level m, the finest with
/// values, gets the value if the shape has one of its voxels.
template <class Shape>
class ShapePaint {
 public:
  ShapePaint(const EditNodes& nodes, EditValues& values, const Shape& shape, int finest_level,
             std::uint32_t value)
      : nodes_(nodes),
        values_(values),
        shape_(shape),
        finest_(finest_level),
        value_(value),
        levels_(nodes.levels()) {}

  /// Returns the overlay after the edit.
  std::uint32_t run(std::uint32_t root, std::uint32_t overlay) {
    return paint(0, root, overlay, {});
  }

 private:
  std::uint32_t paint(int level, std::uint32_t node, std::uint32_t overlay, Vec3i origin) {
    if (node == EditNodes::kNone || overlay == value_) return overlay;
    const CellPlace place = shape_.place(origin, levels_ - level);
    if (place == CellPlace::kOutside) return overlay;
    if (place == CellPlace::kInside) return value_;
    if (level == finest_) return has_voxel(level, node, origin) ? value_ : overlay;
    if (level == levels_ - 2)
      return paint_block(nodes_.block(node) & shape_.block(origin), overlay);
    const std::int32_t half = std::int32_t{1} << (levels_ - level - 1);
    std::uint32_t children[8];
    for (int i = 0; i < 8; ++i)
      children[i] = paint(level + 1, nodes_.child(node, i), values_.child(overlay, i),
                          origin + child_offset(i) * half);
    return values_.add(children);
  }

  std::uint32_t paint_block(std::uint64_t painted, std::uint32_t overlay) {
    if (painted == 0) return overlay;
    std::uint32_t octants[8];
    for (int i = 0; i < 8; ++i) {
      octants[i] = values_.child(overlay, i);
      const auto voxels = static_cast<std::uint32_t>(painted >> (8 * i) & 0xFF);
      if (voxels == 0) continue;
      if (finest_ == levels_ - 1 || voxels == 0xFF) {
        octants[i] = value_;
        continue;
      }
      std::uint32_t children[8];
      for (int k = 0; k < 8; ++k)
        children[k] = (voxels >> k & 1) != 0 ? value_ : values_.child(octants[i], k);
      octants[i] = values_.add(children);
    }
    return values_.add(octants);
  }

  /// Returns whether the shape has a voxel of the cell.
  bool has_voxel(int level, std::uint32_t node, Vec3i origin) const {
    if (node == EditNodes::kNone) return false;
    const CellPlace place = shape_.place(origin, levels_ - level);
    if (place != CellPlace::kMixed) return place == CellPlace::kInside;
    if (level == levels_ - 2) return (nodes_.block(node) & shape_.block(origin)) != 0;
    const std::int32_t half = std::int32_t{1} << (levels_ - level - 1);
    for (int i = 0; i < 8; ++i)
      if (has_voxel(level + 1, nodes_.child(node, i), origin + child_offset(i) * half)) return true;
    return false;
  }

  const EditNodes& nodes_;
  EditValues& values_;
  const Shape& shape_;
  const int finest_;
  const std::uint32_t value_;
  const int levels_;
};

/// Gives values to cells of level m, the finest with values, that had no voxels before an edit.
/// `Values` is a function (level, Vec3i cell) that returns the reference for all new voxels in a
/// cell, or kStoredValue to be asked for its children; of level m, it must return a value.
template <class Values>
class NewCellsPaint {
 public:
  NewCellsPaint(const EditNodes& nodes, EditValues& values, int finest_level, const Values& value)
      : nodes_(nodes),
        values_(values),
        finest_(finest_level),
        value_(value),
        levels_(nodes.levels()) {}

  /// Returns the overlay after an edit that changed the root from `before` to `after`.
  std::uint32_t run(std::uint32_t before, std::uint32_t after, std::uint32_t overlay) {
    return paint(0, before, after, overlay, {});
  }

 private:
  /// `cell` counts in cells of `level`.
  std::uint32_t paint(int level, std::uint32_t before, std::uint32_t after, std::uint32_t overlay,
                      Vec3i cell) {
    if (before == after || after == EditNodes::kNone) return overlay;
    if (level == levels_ - 2) {
      const std::uint64_t old = before == EditNodes::kNone ? 0 : nodes_.block(before);
      return paint_block(old, nodes_.block(after), overlay, cell);
    }
    if (before == EditNodes::kNone)
      if (const std::uint32_t value = value_(level, cell); value != kStoredValue) return value;
    if (level == finest_) return overlay;
    std::uint32_t children[8];
    for (int i = 0; i < 8; ++i)
      children[i] = paint(level + 1, nodes_.child(before, i), nodes_.child(after, i),
                          values_.child(overlay, i), cell + cell + child_offset(i));
    return values_.add(children);
  }

  std::uint32_t paint_block(std::uint64_t before, std::uint64_t after, std::uint32_t overlay,
                            Vec3i cell) {
    const int level = levels_ - 2;
    if ((after & ~before) == 0) return overlay;
    if (before == 0)
      if (const std::uint32_t value = value_(level, cell); value != kStoredValue) return value;
    if (level == finest_) return overlay;
    std::uint32_t octants[8];
    for (int i = 0; i < 8; ++i) {
      octants[i] = values_.child(overlay, i);
      const auto old = static_cast<std::uint32_t>(before >> (8 * i) & 0xFF),
                 now = static_cast<std::uint32_t>(after >> (8 * i) & 0xFF) & ~old;
      if (now == 0) continue;
      const Vec3i octant = cell + cell + child_offset(i);
      if (old == 0)
        if (const std::uint32_t value = value_(level + 1, octant); value != kStoredValue) {
          octants[i] = value;
          continue;
        }
      if (level + 1 == finest_) continue;
      std::uint32_t children[8];
      for (int k = 0; k < 8; ++k)
        children[k] = (now >> k & 1) != 0 ? value_(level + 2, octant + octant + child_offset(k))
                                          : values_.child(octants[i], k);
      octants[i] = values_.add(children);
    }
    return values_.add(octants);
  }

  const EditNodes& nodes_;
  EditValues& values_;
  const int finest_;
  const Values& value_;
  const int levels_;
};

}  // namespace voxdag
