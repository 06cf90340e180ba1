#pragma once
/// The 64-bit word that describes the children of a non-leaf voxel of an ESVO.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 3.1 and Figure 2.
///
///   children  | child pointer 15 | far 1 | valid mask 8 | leaf mask 8 |    bits 31..0
///   contours  | contour pointer 24           | contour mask 8         |    bits 31..0
///
/// Child slot i (x=1, y=2, z=4) is empty, or an inner voxel (valid), or a leaf (valid and leaf).
/// The inner voxels have descriptors of their own, stored together in the order of i. The child
/// pointer leads to the first of them. If it is too far away for 15 bits, or in another block,
/// `far` is set and the child pointer leads to a far pointer.
#include <cassert>
#include <cstdint>
#include <type_traits>

#include "voxdag/core/bits.hpp"

namespace voxdag {

struct ChildDescriptor {
  static constexpr std::uint32_t kMaxChildPointer = (1u << 15) - 1;
  static constexpr std::uint32_t kMaxContourPointer = (1u << 24) - 1;

  std::uint32_t children = 0, contours = 0;

  /// Makes a descriptor without pointers. Only valid children may be leaves or have contours.
  static ChildDescriptor make(std::uint32_t valid_mask, std::uint32_t leaf_mask,
                              std::uint32_t contour_mask) {
    assert(valid_mask < 256 && (leaf_mask & ~valid_mask) == 0 && (contour_mask & ~valid_mask) == 0);
    return {valid_mask << 8 | leaf_mask, contour_mask};
  }
  /// Sets the child pointer: `slots` is the distance from this descriptor to the first child's
  /// descriptor, or to the far pointer.
  void set_child_pointer(std::uint32_t slots, bool is_far) {
    assert(slots <= kMaxChildPointer);
    children = (children & 0xFFFFu) | slots << 17 | (is_far ? 1u << 16 : 0u);
  }
  /// Sets the contour pointer: `words` is the distance from this descriptor to its first contour,
  /// in words of 32 bits.
  void set_contour_pointer(std::uint32_t words) {
    assert(words <= kMaxContourPointer);
    contours = (contours & 0xFFu) | words << 8;
  }

  VOXDAG_HD std::uint32_t valid_mask() const { return children >> 8 & 0xFFu; }
  VOXDAG_HD std::uint32_t leaf_mask() const { return children & 0xFFu; }
  /// Returns the mask of the children that have descriptors.
  VOXDAG_HD std::uint32_t inner_mask() const { return valid_mask() & ~leaf_mask(); }
  VOXDAG_HD std::uint32_t child_pointer() const { return children >> 17; }
  VOXDAG_HD bool is_far() const { return (children >> 16 & 1u) != 0; }
  VOXDAG_HD std::uint32_t contour_mask() const { return contours & 0xFFu; }
  VOXDAG_HD std::uint32_t contour_pointer() const { return contours >> 8; }

  VOXDAG_HD static ChildDescriptor from_slot(std::uint64_t slot) {
    return {static_cast<std::uint32_t>(slot), static_cast<std::uint32_t>(slot >> 32)};
  }
  VOXDAG_HD std::uint64_t to_slot() const {
    return children | static_cast<std::uint64_t>(contours) << 32;
  }
  friend bool operator==(const ChildDescriptor&, const ChildDescriptor&) = default;
};
static_assert(sizeof(ChildDescriptor) == 8 && std::is_trivially_copyable_v<ChildDescriptor>);

}  // namespace voxdag
