#pragma once
/// The directory of an ESVO's blocks: the data that streaming needs about a block before it loads
/// it.
#include <cstdint>

#include "voxdag/core/vec.hpp"

namespace voxdag {

/// One block. It holds the octree below one voxel: the descriptors of the voxel's inner children
/// and their descendants. The root's block holds the root's own descriptor.
struct EsvoBlockEntry {
  static constexpr std::uint64_t kNoParent = ~std::uint64_t{0};

  std::uint64_t begin = 0;  ///< First slot; a multiple of kEsvoPageSlots.
  /// The slot of the voxel's descriptor, in another block, whose far pointer leads here.
  std::uint64_t parent = kNoParent;
  std::uint64_t checksum = 0;  ///< XXH3-64 of the block's slots; 0 if the block is not in a file.
  std::uint32_t slots = 0;
  std::int32_t level = 0;  ///< Level of the voxel; 0 for the root's block, too.
  Vec3i cell{};            ///< The voxel's coordinates among the cells of its level.
  std::uint32_t reserved = 0;

  friend bool operator==(const EsvoBlockEntry&, const EsvoBlockEntry&) = default;
};
static_assert(sizeof(EsvoBlockEntry) == 48);

}  // namespace voxdag
