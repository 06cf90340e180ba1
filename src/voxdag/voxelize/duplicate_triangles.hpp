#pragma once
/// Finds triangles that cover what another triangle covers.
#include <cstddef>
#include <cstdint>
#include <functional>

#include "voxdag/core/page_vector.hpp"
#include "voxdag/parallel/progress.hpp"
#include "voxdag/voxelize/grid_mapping.hpp"

namespace voxdag {

/// A set of a mesh's triangles, one bit for each.
class TriangleSet {
 public:
  explicit TriangleSet(MemoryBudget* budget = nullptr) : words_(budget) {}

  bool contains(std::size_t triangle) const {
    return !words_.empty() && ((words_[triangle / 64] >> (triangle % 64)) & 1) != 0;
  }
  std::size_t count() const;

 private:
  friend TriangleSet find_duplicates(const QuantizedMesh& mesh,
                                     const std::function<std::uint64_t(std::size_t)>& look,
                                     MemoryBudget* budget, Progress* progress);
  PageVector<std::uint64_t> words_;  ///< Empty if the set is.
};

/// Returns all triangles that are exact duplicates of one with a lower index: the same three
/// corners on the grid, in any order. If `look` is not empty, look(triangle) has to be equal, too.
/// Triangles that are not in range are in no set; their pieces are. Deterministic. Time is linear
/// in the triangles; takes 12 bytes for each of them while it works and a bit after. Throws
/// OverMemory and Cancelled.
TriangleSet find_duplicates(const QuantizedMesh& mesh,
                            const std::function<std::uint64_t(std::size_t)>& look = {},
                            MemoryBudget* budget = nullptr, Progress* progress = nullptr);

}  // namespace voxdag
