#pragma once
/// Whether the slots of an ESVO are what esvo.hpp says, for data that comes from outside.
#include <span>
#include <vector>

#include "voxdag/layout/esvo.hpp"
#include "voxdag/layout/esvo_counts.hpp"
#include "voxdag/layout/esvo_directory.hpp"

namespace voxdag {

/// A descriptor whose children are in another block.
struct EsvoFarLink {
  std::uint32_t slot = 0;   ///< Of the descriptor, from its block's begin.
  std::int64_t target = 0;  ///< The first child, from the same begin.
  int level = 0;            ///< Of the descriptor's voxel.
  Vec3i cell{};
  std::vector<Vec3i> siblings;  ///< The cells of the children that have descriptors.
};

/// What is found in one block.
struct EsvoBlockCheck {
  EsvoCounts counts;
  std::vector<EsvoFarLink> links;
};

/// One block by itself: its info section and page headers hold together; from its first group, of
/// the descriptors of the voxels at `siblings`, every descriptor is reached once, stands between
/// page headers with its siblings on one page, and no voxel of level `levels` has children;
/// contours are in the block and have a normal. Of `entry` the level counts, and whether there is a
/// parent. Throws Error("", place, reason) at the first fault; place is "slot 4711" of the block or
/// empty. O(block) time, one bit of memory per slot.
EsvoBlockCheck check_esvo_block(std::span<const std::uint64_t> slots, const EsvoBlockEntry& entry,
                                std::span<const Vec3i> siblings, int levels);

/// Safety: a view that passes can be walked, and the attributes of its voxels looked up, by any
/// code without a check. The blocks of the directory lie back to back and fill the slots; each is
/// sound by itself, reached once from the root, and its entry says by which descriptor and for
/// which cell. Returns the counts. Throws Error("", place, reason) at the first fault; place is
/// "block 3" or "block 3, slot 4711". O(ESVO) time. `view.slots` must have slot_count words.
EsvoCounts validate_esvo(const EsvoView& view, std::span<const EsvoBlockEntry> directory);

}  // namespace voxdag
