#pragma once
/// Whether the slots of an ESVO are what esvo.hpp says, for data that comes from outside.
#include <span>

#include "voxdag/layout/esvo.hpp"
#include "voxdag/layout/esvo_counts.hpp"
#include "voxdag/layout/esvo_directory.hpp"

namespace voxdag {

/// Safety: a view that passes can be walked, and the attributes of its voxels looked up, by any
/// code without a check. The blocks of the directory lie back to back and fill the slots; their
/// info sections and page headers hold together; from the root every descriptor is reached once,
/// stands between page headers with its siblings on one page of one block, and no voxel of level L
/// has children; contours are in their block and have a normal. Where an entry has a parent, that
/// descriptor's far pointer leads to the block, and its level and cell are those of the walk.
/// Returns the counts. Throws Error("", place, reason) at the first fault; place is "block 3" or
/// "slot 4711". O(ESVO) time, one bit of memory per slot. `view.slots` must have slot_count words.
EsvoCounts validate_esvo(const EsvoView& view, std::span<const EsvoBlockEntry> directory);

/// What one block says of itself: its info section and its page headers. `slots` is the block's.
/// Throws Error("", "", reason).
void check_esvo_block(std::span<const std::uint64_t> slots);

}  // namespace voxdag
