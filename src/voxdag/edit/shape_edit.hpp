#pragma once
/// Adds a shape to a DAG, removes it, and gives values to the voxels of a shape.
///
/// Recursion from the root. A cell outside of the shape keeps its node, and a cell inside becomes a
/// full node or none, at once; so the cost follows the cells that the surface of the shape cuts.
/// If voxels are removed, only cells with voxels count; if added, only cells that are not full.
#include <algorithm>

#include "voxdag/core/morton.hpp"
#include "voxdag/edit/edit_nodes.hpp"
#include "voxdag/edit/edit_values.hpp"
#include "voxdag/edit/shapes.hpp"

namespace voxdag {

/// Changes the voxels of a shape.
template <class Shape>
class ShapeEdit {
 public:
  ShapeEdit(EditNodes& nodes, const Shape& shape, bool adds)
      : nodes_(nodes), shape_(shape), adds_(adds), levels_(nodes.levels()) {}

  /// Returns the root after the edit. Throws what EditNodes::intern() throws.
  std::uint32_t run(std::uint32_t root) { return edit(0, root, {}); }

 private:
  std::uint32_t edit(int level, std::uint32_t node, Vec3i origin) {
    if (node == (adds_ ? nodes_.full(level) : EditNodes::kNone)) return node;
    switch (shape_.place(origin, levels_ - level)) {
      case CellPlace::kOutside:
        return node;
      case CellPlace::kInside:
        return adds_ ? nodes_.full(level) : EditNodes::kNone;
      default:
        break;
    }
    if (level == levels_ - 2) {
      const std::uint64_t before = node == EditNodes::kNone ? 0 : nodes_.block(node),
                          of_shape = shape_.block(origin),
                          after = adds_ ? before | of_shape : before & ~of_shape;
      return after == before ? node : nodes_.intern_block(after);
    }
    const std::int32_t half = std::int32_t{1} << (levels_ - level - 1);
    std::uint32_t children[8];
    bool is_changed = false;
    for (int i = 0; i < 8; ++i) {
      const std::uint32_t child = nodes_.child(node, i);
      children[i] = edit(level + 1, child, origin + child_offset(i) * half);
      is_changed |= children[i] != child;
    }
    return is_changed ? nodes_.intern(level, children) : node;
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
