#pragma once
/// Validation of an ESVO from an untrusted source against the layout in esvo.hpp.
#include <span>
#include <vector>

#include "voxdag/stored/esvo/esvo.hpp"
#include "voxdag/stored/esvo/esvo_counts.hpp"
#include "voxdag/stored/esvo/esvo_directory.hpp"

namespace voxdag {

/// A descriptor whose children are in another block.
struct EsvoFarLink {
  std::uint32_t slot = 0;   ///< The descriptor, counted from its block's begin.
  std::int64_t target = 0;  ///< The first child, counted from the same begin.
  int level = 0;            ///< Level of the descriptor's voxel.
  Vec3i cell{};
  std::vector<Vec3i> siblings;  ///< The cells of the children that have descriptors.
};

/// The result of checking one block.
struct EsvoBlockCheck {
  EsvoCounts counts;
  std::vector<EsvoFarLink> links;
};

/// Checks one block by itself. The info section and the page headers must agree. A walk starts at
/// the block's first group, the descriptors of the voxels at `siblings`, and must reach every
/// descriptor once. Siblings must lie on one page, between page headers. No voxel of level `levels`
/// may have children. Contours must lie in the block and have a normal. Of `entry` only the level
/// counts, and whether there is a parent. Throws Error("", place, reason) at the first fault; the
/// place is a slot of the block, or empty. O(block) time, one bit of memory per slot.
EsvoBlockCheck check_esvo_block(std::span<const std::uint64_t> slots, const EsvoBlockEntry& entry,
                                std::span<const Vec3i> siblings, int levels);

/// Checks that any code can walk the view, and look up its voxels' attributes, without further
/// checks. The blocks of the directory must lie back to back and fill the slots. Each must pass
/// check_esvo_block(), and exactly one descriptor must lead to it: the one that its entry names,
/// for the cell that its entry names. Returns the counts. Throws Error("", place, reason) at the
/// first fault; the place is "block 3" or "block 3, slot 4711". O(ESVO) time. `view.slots` must
/// have slot_count words.
EsvoCounts validate_esvo(const EsvoView& view, std::span<const EsvoBlockEntry> directory);

}  // namespace voxdag
