#pragma once
/// The values of a pair of descriptors as their compression blocks.
#include <cstdint>

#include "voxdag/esvo/esvo_tree.hpp"

namespace voxdag {

/// The 16 values of a pair of slots; those that no voxel has are not in the mask.
struct PairValues {
  /// What a leaf weighs beside an inner voxel: leaves may be large and seen from near, inner voxels
  /// are seen from where they are smaller than a pixel.
  static constexpr float kLeafWeight = 16;

  std::uint32_t mask = 0;
  VoxelValue values[16];
  float weights[16] = {};

  void set(std::uint32_t at, const VoxelValue& value, bool is_leaf) {
    mask |= 1u << at;
    values[at] = value;
    weights[at] = is_leaf ? kLeafWeight : 1.0f;
  }
};

/// Writes one slot, a colour block. At least one value is set.
void encode_pair_colors(const PairValues& values, std::uint64_t* block);

/// Writes two slots, a normal block. At least one value is set.
void encode_pair_normals(const PairValues& values, std::uint64_t* block);

}  // namespace voxdag
