#pragma once
/// An efficient sparse voxel octree: blocks of child descriptors, contours and attachments.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 3.
///
/// Everything is one array of 64-bit slots. A block is a whole number of pages of 1024 slots (8 KB)
/// and holds a connected part of the octree:
///
///   descriptors   descriptor_slots, an even number
///     slot 0 of each page    page header: the distance in slots from here to the block's info
///     other slots            child descriptors, far pointers, gaps (zero)
///   EsvoBlockInfo            where everything is
///   contours                 32-bit words, padded to a slot; siblings' lists may overlap
///   attachments              arrays of compression blocks, one block for each pair of slots
///   padding                  zeros
///
/// A far pointer is a signed 32-bit distance in slots from the descriptor that uses it to the first
/// of its children's descriptors. Descriptors with the same parent are stored together within one
/// page. The two descriptors in a pair of slots (2i, 2i + 1) have the same parent, and their
/// children share a compression block: child c of the descriptor in slot s has value 8 * (s & 1) +
/// c of compression block s / 2. Slots are counted from the block's begin.
///
/// All references in a block are relative to their own position. Only far pointers leave a block;
/// they lead to the first descriptors of other blocks.
#include <cstddef>
#include <cstdint>
#include <vector>

#include "voxdag/core/grid.hpp"
#include "voxdag/stored/esvo/child_descriptor.hpp"
#include "voxdag/stored/esvo/contour.hpp"

namespace voxdag {

inline constexpr std::uint32_t kEsvoPageSlots = 1024;

/// The kind of values in an attachment.
enum class EsvoAttachmentKind : std::uint32_t {
  kNone = 0,
  kColors = 1,   ///< stored/esvo/color_block.hpp: one slot per block.
  kNormals = 2,  ///< stored/esvo/normal_block.hpp: two slots per block.
};

struct EsvoAttachment {
  EsvoAttachmentKind kind;
  std::uint32_t begin;           ///< Slot from the block's begin.
  std::uint32_t slots_per_pair;  ///< Slots of one compression block.
  std::uint32_t count;           ///< Number of compression blocks: descriptor_slots / 2.
};
static_assert(sizeof(EsvoAttachment) == 16);

/// The info section. Slots are counted from the block's begin.
struct EsvoBlockInfo {
  static constexpr std::uint32_t kMaxAttachments = 4;

  std::uint32_t slots;             ///< Size of the whole block.
  std::uint32_t descriptor_slots;  ///< Also the slot where this section begins.
  std::uint32_t first_descriptor;  ///< First of the group of siblings that all others descend from.
  std::uint32_t far_pointers;      ///< Number of them.
  std::uint32_t contour_begin;     ///< Slot of the first contour.
  std::uint32_t contour_count;     ///< Stored contours: equal lists of siblings are stored once.
  std::uint32_t descriptors;       ///< Number of them.
  std::uint32_t attachment_count;
  EsvoAttachment attachments[kMaxAttachments];

  /// Returns the attachment of this kind, or null.
  VOXDAG_HD const EsvoAttachment* find(EsvoAttachmentKind kind) const {
    for (std::uint32_t i = 0; i < attachment_count; ++i)
      if (attachments[i].kind == kind) return attachments + i;
    return nullptr;
  }
};
static_assert(sizeof(EsvoBlockInfo) == 96 && offsetof(EsvoBlockInfo, attachments) == 32);

/// A voxel: child `child` of the descriptor in `slot`.
struct EsvoVoxel {
  std::uint64_t slot = 0;
  int child = 0;
};

/// A view for kernels and readers: points to the slots and owns nothing.
struct EsvoView {
  const std::uint64_t* slots = nullptr;
  std::uint64_t slot_count = 0;
  std::uint64_t root = 0;   ///< Slot of the root's descriptor.
  int levels = kMinLevels;  ///< L: voxels of level L, the finest, have a side of 1.

  /// Returns whether there are no voxels: then there are no slots at all.
  VOXDAG_HD bool is_empty() const { return slot_count == 0; }
  /// Returns the descriptor in `slot`.
  VOXDAG_HD ChildDescriptor descriptor(std::uint64_t slot) const {
    return ChildDescriptor::from_slot(slots[slot]);
  }

  /// Returns the slot of the first descriptor of the children. `descriptor` is the one in `slot`
  /// and must have an inner child.
  VOXDAG_HD std::uint64_t first_child(std::uint64_t slot, ChildDescriptor descriptor) const {
    const std::uint64_t to = slot + descriptor.child_pointer();
    if (!descriptor.is_far()) return to;
    const auto distance = static_cast<std::int32_t>(static_cast<std::uint32_t>(slots[to]));
    return slot + static_cast<std::uint64_t>(static_cast<std::int64_t>(distance));
  }
  /// Returns the slot of the descriptor of `child`, which must be an inner child.
  VOXDAG_HD std::uint64_t child(std::uint64_t slot, ChildDescriptor descriptor, int child) const {
    const std::uint32_t before = descriptor.inner_mask() & ((1u << child) - 1u);
    return first_child(slot, descriptor) + static_cast<std::uint64_t>(popcount8(before));
  }
  /// Returns the contour of `child`, which must have one.
  VOXDAG_HD Contour contour(std::uint64_t slot, ChildDescriptor descriptor, int child) const {
    const std::uint32_t before = descriptor.contour_mask() & ((1u << child) - 1u);
    const std::uint64_t word =
        2 * slot + descriptor.contour_pointer() + static_cast<std::uint64_t>(popcount8(before));
    return {static_cast<std::uint32_t>(slots[word >> 1] >> (32 * (word & 1)))};
  }

  /// Returns the slot of the info section of the block that holds descriptor slot `slot`.
  VOXDAG_HD std::uint64_t info_slot(std::uint64_t slot) const {
    const std::uint64_t page = slot & ~std::uint64_t{kEsvoPageSlots - 1};
    return page + static_cast<std::uint32_t>(slots[page]);
  }
  /// Returns the info section of the block that holds descriptor slot `slot`.
  VOXDAG_HD const EsvoBlockInfo& info(std::uint64_t slot) const {
    return *reinterpret_cast<const EsvoBlockInfo*>(slots + info_slot(slot));
  }
  /// Returns the compression block of `kind` for the children of the descriptor in `slot`, or null.
  VOXDAG_HD const std::uint64_t* attachment(std::uint64_t slot, EsvoAttachmentKind kind) const {
    const std::uint64_t at = info_slot(slot);
    const auto& block = *reinterpret_cast<const EsvoBlockInfo*>(slots + at);
    const EsvoAttachment* found = block.find(kind);
    if (found == nullptr) return nullptr;
    const std::uint64_t begin = at - block.descriptor_slots;
    return slots + begin + found->begin + (slot - begin) / 2 * found->slots_per_pair;
  }
};

/// Returns the voxel's index (0..15) in its compression blocks.
VOXDAG_HD constexpr int attachment_value(const EsvoVoxel& voxel) {
  return static_cast<int>(voxel.slot & 1) * 8 + voxel.child;
}

/// An octree in memory. The view is valid while this object lives unchanged.
struct Esvo {
  std::vector<std::uint64_t> slots;
  std::uint64_t root = 0;
  int levels = kMinLevels;

  EsvoView view() const { return {slots.data(), slots.size(), root, levels}; }
  friend bool operator==(const Esvo&, const Esvo&) = default;
};

}  // namespace voxdag
