#pragma once
/// The colours of a DAG's cells, filtered and not compressed.
#include <vector>

#include "voxdag/builders/attributes/cell_value_sink.hpp"
#include "voxdag/stored/attributes/value_pages.hpp"

namespace voxdag::lab {

/// Keeps the colours of all cells, by number.
class CellColors : public CellValueSink {
 public:
  explicit CellColors(std::uint64_t cells) : colors(cells) {}

  bool needs_normals() const override { return false; }

  void add(std::uint64_t first, std::span<const VoxelValue> values) override {
    for (const VoxelValue& value : values)
      colors[first++] = {value.color[0], value.color[1], value.color[2]};
  }

  std::vector<Value8> colors;
};

}  // namespace voxdag::lab
