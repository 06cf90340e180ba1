#pragma once
/// The values of a pair of descriptors as their compression blocks.
#include <cstdint>

#include "voxdag/esvo/encode/esvo_tree.hpp"

namespace voxdag {

/// The 16 values of a pair of slots; those that no voxel has are not in the mask.
struct PairValues {
  std::uint32_t mask = 0;
  std::uint32_t leaves = 0;  ///< Bit i: value i is of a leaf.
  VoxelValue values[16];

  void set(std::uint32_t at, const VoxelValue& value, bool is_leaf) {
    mask |= 1u << at;
    leaves |= is_leaf ? 1u << at : 0u;
    values[at] = value;
  }
};

/// Writes one slot, a colour block. At least one value is set.
void encode_pair_colors(const PairValues& values, std::uint64_t* block);

/// Writes two slots, a normal block. At least one value is set.
void encode_pair_normals(const PairValues& values, std::uint64_t* block);

}  // namespace voxdag
