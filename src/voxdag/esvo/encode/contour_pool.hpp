#pragma once
/// The contours of a block: lists of those of siblings, each run of equal ones stored once.
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "voxdag/layout/contour.hpp"

namespace voxdag {

/// Walls along an axis have the same contours again and again, voxel after voxel, so lists are kept
/// once, and a list that is a part of another one needs no place of its own. For most sharing add
/// long lists first.
class ContourPool {
 public:
  /// Where `list` (1 to 8 contours) stands among contours().
  std::uint32_t add(std::span<const Contour> list);

  const std::vector<Contour>& contours() const { return contours_; }

 private:
  std::vector<Contour> contours_;
  std::unordered_map<std::uint64_t, std::uint32_t> places_;  // by hash of a run: where it stands
};

}  // namespace voxdag
