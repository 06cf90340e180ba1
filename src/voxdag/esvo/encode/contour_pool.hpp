#pragma once
/// Stores the contours of a block: one list per group of siblings, equal lists once.
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "voxdag/layout/contour.hpp"

namespace voxdag {

/// Walls along an axis repeat their contours voxel after voxel. A list that equals a list, or a
/// part of a list, that was added before takes no room. Add long lists first for most sharing.
class ContourPool {
 public:
  /// Returns the index of `list` (1 to 8 contours) in contours().
  std::uint32_t add(std::span<const Contour> list);

  const std::vector<Contour>& contours() const { return contours_; }

 private:
  std::vector<Contour> contours_;
  std::unordered_map<std::uint64_t, std::uint32_t> places_;  // hash of a run to its index
};

}  // namespace voxdag
