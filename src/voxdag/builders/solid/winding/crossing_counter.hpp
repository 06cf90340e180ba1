#pragma once
/// How often rays cross a surface, with their directions.
#include <cstdint>
#include <span>

#include "voxdag/builders/solid/ray_bins.hpp"
#include "voxdag/core/parallel/progress.hpp"

namespace voxdag {

/// Counts for each voxel the crossings of the ray from its point (winding_point.hpp) along +x:
/// those to the side from which a triangle's corners run counter-clockwise, less those from it. The
/// winding number of a closed surface is the sum over its triangles.
class CrossingCounter {
 public:
  /// There must be voxels, which must outlive this object. Counts 8 bytes for each in `memory`.
  /// Throws OverMemory.
  CrossingCounter(std::span<const Vec3i> voxels, MemoryBudget* memory);

  /// Adds `times` the crossings of the triangle. Thread-safe.
  void add(const QuantizedTriangle& triangle, std::int32_t times);
  std::int32_t crossings(std::size_t voxel) const { return crossings_[voxel]; }

 private:
  std::span<const Vec3i> voxels_;
  RayBins bins_;
  CountedVector<std::int32_t> crossings_;
};

}  // namespace voxdag
