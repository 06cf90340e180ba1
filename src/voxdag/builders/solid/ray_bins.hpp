#pragma once
/// Finds the voxels whose rays along x cross a triangle.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>

#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/memory_budget.hpp"

namespace voxdag {

/// Voxels by where their rays pass in the plane of y and z.
class RayBins {
 public:
  /// There must be voxels. Counts 4 bytes for each in `memory`. Throws OverMemory.
  RayBins(std::span<const Vec3i> voxels, MemoryBudget* memory) : begin_(memory), order_(memory) {
    low_ = voxels.front();
    Vec3i high = low_;
    for (const Vec3i v : voxels) {
      low_ = min(low_, v);
      high = max(high, v);
    }
    const auto across = static_cast<std::int32_t>(
        std::clamp(std::sqrt(static_cast<double>(voxels.size())), 1.0, 2048.0));
    width_ = std::max(high.y - low_.y, high.z - low_.z) / across + 1;
    columns_ = (high.y - low_.y) / width_ + 1;
    rows_ = (high.z - low_.z) / width_ + 1;
    begin_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0);
    for (const Vec3i v : voxels) ++begin_[bin_of(v) + 1];
    for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    order_.resize(voxels.size());
    CountedVector<std::uint32_t> next(begin_.begin(), begin_.end() - 1, memory);
    for (std::uint32_t i = 0; i < voxels.size(); ++i) order_[next[bin_of(voxels[i])]++] = i;
  }

  /// Calls visit(index) for all voxels that may lie between these voxels in y and z.
  template <class Visit>
  void each_between(Vec3i lo, Vec3i hi, const Visit& visit) const {
    const std::int32_t first_column = std::max((lo.y - low_.y) / width_, 0),
                       last_column = std::min((hi.y - low_.y) / width_, columns_ - 1),
                       first_row = std::max((lo.z - low_.z) / width_, 0),
                       last_row = std::min((hi.z - low_.z) / width_, rows_ - 1);
    if (hi.y < low_.y || hi.z < low_.z || first_column > last_column) return;
    for (std::int32_t row = first_row; row <= last_row; ++row) {
      const std::size_t bins = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_);
      const std::size_t begin = begin_[bins + static_cast<std::size_t>(first_column)],
                        end = begin_[bins + static_cast<std::size_t>(last_column) + 1];
      for (std::size_t i = begin; i < end; ++i) visit(order_[i]);
    }
  }

  /// Calls visit(index) for all voxels whose rays may cross the triangle.
  template <class Visit>
  void each_behind(const QuantizedTriangle& t, const Visit& visit) const {
    const Vec3i lo = min(min(t.x, t.y), t.z), hi = max(max(t.x, t.y), t.z);
    each_between({0, lo.y >> 8, lo.z >> 8}, {0, hi.y >> 8, hi.z >> 8}, visit);
  }

 private:
  std::size_t bin_of(Vec3i v) const {
    return static_cast<std::size_t>((v.z - low_.z) / width_) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>((v.y - low_.y) / width_);
  }

  Vec3i low_;
  std::int32_t width_ = 1, columns_ = 1, rows_ = 1;
  CountedVector<std::uint32_t> begin_, order_;
};

}  // namespace voxdag
