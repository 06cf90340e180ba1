#pragma once
/// The contours of a block: one list for each set of siblings. Equal runs are stored once.
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "voxdag/stored/esvo/contour.hpp"

namespace voxdag {

/// Walls along an axis repeat the same contours voxel after voxel. So equal lists are stored once,
/// and a list that is part of another list needs no memory of its own. Add long lists first to
/// share the most.
class ContourPool {
 public:
  /// Returns the index in contours() at which `list` (1 to 8 contours) begins.
  std::uint32_t add(std::span<const Contour> list);

  const std::vector<Contour>& contours() const { return contours_; }

 private:
  std::vector<Contour> contours_;
  std::unordered_map<std::uint64_t, std::uint32_t> places_;  // hash of a run to its index
};

}  // namespace voxdag
