#pragma once
/// Where the blocks of an ESVO are: what streaming needs to know of a block before it is loaded.
#include <cstdint>

#include "voxdag/core/vec.hpp"

namespace voxdag {

/// One block. It holds what is below one voxel, its cell: the descriptors of the voxel's inner
/// children and what hangs from them. The root's block holds the root's own descriptor.
struct EsvoBlockEntry {
  static constexpr std::uint64_t kNoParent = ~std::uint64_t{0};

  std::uint64_t begin = 0;  ///< First slot; a multiple of kEsvoPageSlots.
  /// The slot of the descriptor of the voxel, in another block: its far pointer leads here.
  std::uint64_t parent = kNoParent;
  std::uint64_t checksum = 0;  ///< XXH3-64 of the block's slots; 0 where it is not in a file.
  std::uint32_t slots = 0;
  std::int32_t level = 0;  ///< Of the voxel; 0 for the root's block, too.
  Vec3i cell{};            ///< Its coordinates in the grid of cells of that level.
  std::uint32_t reserved = 0;

  friend bool operator==(const EsvoBlockEntry&, const EsvoBlockEntry&) = default;
};
static_assert(sizeof(EsvoBlockEntry) == 48);

}  // namespace voxdag
