#pragma once
/// Values that replace the stored ones in some cells: an octree over the grid that edits append to.
///
/// A reference of 32 bits stands for the values of a cell and of all cells in it:
///
///   0                      those of the stored DAG
///   kOverlayValue | value  the same value everywhere in the cell
///   i                      as the eight references from word 8 i on say, in the order of child
///                          indices
///
/// Words that were written do not change while a root refers to them, so an edit makes a new root
/// and shares what it does not touch. A cell without voxels may have a value; it does not count.
#include <cstdint>

#include "voxdag/core/morton.hpp"
#include "voxdag/stored/attributes/value_pages.hpp"

namespace voxdag {

inline constexpr std::uint32_t kStoredValue = 0;
inline constexpr std::uint32_t kOverlayValue = 1u << 31;

/// Returns a reference to one value: a colour, or a normal as pack_normal() makes it.
VOXDAG_HD constexpr std::uint32_t overlay_value(Value8 value) {
  return kOverlayValue | static_cast<std::uint32_t>(value.x) |
         static_cast<std::uint32_t>(value.y) << 8 | static_cast<std::uint32_t>(value.z) << 16;
}
VOXDAG_HD constexpr Value8 value_of_overlay(std::uint32_t reference) {
  return {static_cast<std::uint8_t>(reference), static_cast<std::uint8_t>(reference >> 8),
          static_cast<std::uint8_t>(reference >> 16)};
}
/// Returns a reference to one material.
VOXDAG_HD constexpr std::uint32_t overlay_material(std::uint32_t material) {
  return kOverlayValue | material;
}
VOXDAG_HD constexpr std::uint32_t material_of_overlay(std::uint32_t reference) {
  return reference & ~kOverlayValue;
}

/// A view for kernels and readers.
struct ValueOverlayView {
  const std::uint32_t* words = nullptr;
  std::uint32_t root = kStoredValue;

  VOXDAG_HD bool is_empty() const { return root == kStoredValue; }
};

/// Returns what the overlay says of the cell `cell` of `level`, which must be in the grid:
/// kStoredValue, a value, or words if cells in it have different values.
VOXDAG_HD inline std::uint32_t overlay_at(const ValueOverlayView& overlay, Vec3i cell, int level) {
  std::uint32_t reference = overlay.root;
  for (int l = 0; l < level && reference != kStoredValue && reference < kOverlayValue; ++l)
    reference = overlay.words[std::uint64_t{8} * reference +
                              static_cast<std::uint32_t>(child_index(cell, level - 1 - l))];
  return reference;
}

/// Returns a value of a cell for which overlay_at() said words: the first one in Morton order.
VOXDAG_HD inline std::uint32_t first_in_overlay(const ValueOverlayView& overlay,
                                                std::uint32_t reference) {
  while (reference != kStoredValue && reference < kOverlayValue) {
    const std::uint32_t* const children = overlay.words + std::uint64_t{8} * reference;
    int first = 0;
    while (first < 7 && children[first] == kStoredValue) ++first;
    reference = children[first];
  }
  return reference;
}

/// The overlays of a DAG that is being edited.
struct ValueOverlays {
  ValueOverlayView colors, normals, materials;

  VOXDAG_HD bool is_empty() const {
    return colors.is_empty() && normals.is_empty() && materials.is_empty();
  }
};

}  // namespace voxdag
