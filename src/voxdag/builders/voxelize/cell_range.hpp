#pragma once
/// A run of cells of one octree level: a part of a grid.
#include <cstdint>

namespace voxdag {

/// The cells of `level` (0 to 10) with the Morton codes from `first` to `last` - 1. By default the
/// whole grid.
struct CellRange {
  int level = 0;
  std::uint32_t first = 0, last = 1;

  /// Returns whether a cell of another level shares voxels with the range.
  constexpr bool meets(int cell_level, std::uint32_t code) const {
    if (cell_level >= level) {
      const std::uint32_t ancestor = code >> 3 * (cell_level - level);
      return ancestor >= first && ancestor < last;
    }
    const int down = 3 * (level - cell_level);
    return code << down < last && (code + 1) << down > first;
  }
  friend bool operator==(const CellRange&, const CellRange&) = default;
};

}  // namespace voxdag
