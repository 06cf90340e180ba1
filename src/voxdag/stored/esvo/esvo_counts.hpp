#pragma once
/// Counts of an ESVO's parts.
#include <array>
#include <cstdint>

#include "voxdag/core/grid.hpp"

namespace voxdag {

struct EsvoCounts {
  using PerLevel = std::array<std::uint64_t, kMaxLevels + 1>;  ///< Indexed by level; 0 is the root.

  PerLevel voxels_per_level{};  ///< Inner voxels and leaves.
  PerLevel leaves_per_level{};
  std::uint64_t descriptors = 0;
  std::uint64_t far_pointers = 0;
  std::uint64_t contours =
      0;  ///< Voxels with a contour; voxels of a block may share stored contours.
  std::uint64_t blocks = 0;

  std::uint64_t voxels() const { return sum(voxels_per_level); }
  std::uint64_t leaves() const { return sum(leaves_per_level); }

  EsvoCounts& operator+=(const EsvoCounts& other) {
    for (std::size_t i = 0; i < voxels_per_level.size(); ++i) {
      voxels_per_level[i] += other.voxels_per_level[i];
      leaves_per_level[i] += other.leaves_per_level[i];
    }
    descriptors += other.descriptors;
    far_pointers += other.far_pointers;
    contours += other.contours;
    blocks += other.blocks;
    return *this;
  }
  friend bool operator==(const EsvoCounts&, const EsvoCounts&) = default;

 private:
  static std::uint64_t sum(const PerLevel& counts) {
    std::uint64_t total = 0;
    for (const std::uint64_t count : counts) total += count;
    return total;
  }
};

}  // namespace voxdag
