#pragma once
/// An interface that receives the colours and normals of cells as soon as they are known.
#include <cstdint>
#include <span>

#include "voxdag/builders/pieces/voxel_value.hpp"

namespace voxdag {

class CellValueSink {
 public:
  virtual ~CellValueSink() = default;
  /// Returns whether the sink uses the normals. If it does not, they are meaningless unit vectors.
  virtual bool needs_normals() const { return true; }
  /// Takes the values of the cells from number `first` on. Several threads call it at the same
  /// time, with ranges in any order. Every cell is in exactly one range.
  virtual void add(std::uint64_t first, std::span<const VoxelValue> values) = 0;
};

}  // namespace voxdag
