#pragma once
/// Encodes the values of a pair of descriptors as compression blocks.
#include <cstdint>

#include "voxdag/builders/esvo/encode/esvo_tree.hpp"

namespace voxdag {

/// The 16 values of a pair of slots. Bit i of `mask` is set if value i belongs to a voxel.
struct PairValues {
  std::uint32_t mask = 0;
  std::uint32_t leaves = 0;  ///< Bit i: value i belongs to a leaf.
  VoxelValue values[16];

  void set(std::uint32_t at, const VoxelValue& value, bool is_leaf) {
    mask |= 1u << at;
    leaves |= is_leaf ? 1u << at : 0u;
    values[at] = value;
  }
};

/// Writes a colour block, one slot. At least one value is set.
void encode_pair_colors(const PairValues& values, std::uint64_t* block);

/// Writes a normal block, two slots. At least one value is set.
void encode_pair_normals(const PairValues& values, std::uint64_t* block);

}  // namespace voxdag
