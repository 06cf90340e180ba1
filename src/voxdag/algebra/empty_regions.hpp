#pragma once
/// The connected sets of places without voxels in a DAG, each of which may be filled.
#include <cstdint>
#include <memory>
#include <vector>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/core/vec.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

class Regions;

/// All sets of empty places that are connected over faces.
class EmptyRegions {
 public:
  /// `dag` must be valid, have voxels, and outlive this object. Throws OverMemory and Cancelled.
  explicit EmptyRegions(const SvdagView& dag, Work work = {});
  ~EmptyRegions();
  EmptyRegions(const EmptyRegions&) = delete;
  EmptyRegions& operator=(const EmptyRegions&) = delete;

  /// Returns one place of each region. Those that reach the sides of the grid come first.
  const std::vector<Vec3i>& places() const { return places_; }

  /// Returns the minimal DAG, in canonical order, of all voxels and of the regions i for which
  /// is_filled[i] is true. Throws Error if it outgrows 32-bit pointers, OverMemory and Cancelled.
  Svdag fill(const std::vector<bool>& is_filled) const;

 private:
  void add_places(int level, std::uint32_t node, Vec3i first);

  std::unique_ptr<Regions> regions_;
  Work work_;
  std::vector<Vec3i> places_;
};

}  // namespace voxdag
