#pragma once
/// Encodes the colours of all cells of a DAG from those of its voxels.
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "voxdag/builders/attributes/build_attributes.hpp"
#include "voxdag/formats/imports/voxel_source.hpp"
#include "voxdag/stored/attributes/value_encoder.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// Takes the colours of voxels in Morton order, and gives the encoder those of all cells by their
/// numbers (stored/attributes/cell_index.hpp). A voxel has the mean of its colours, and a cell that
/// of its voxels, in linear light.
class CellColors {
 public:
  /// A grid of 2^levels voxels a side. Refers to the encoder, which must expect all its cells.
  CellColors(int levels, ValueEncoder& encoder);

  /// Adds a colour of the voxel of a Morton code. Codes do not descend. Throws OverMemory.
  void add(std::uint64_t code, Rgb8 color);
  /// Call it last. Throws OverMemory.
  void finish();

 private:
  /// A cell on the path to the last voxel.
  struct OpenCell {
    std::uint64_t number = 0;
    std::array<std::uint64_t, 3> sum{};  ///< Of the colours, in linear light.
    std::uint64_t count = 0;             ///< Of colours.
  };

  void open(int level);
  void close(int level);

  int levels_;
  ValueEncoder& encoder_;
  std::vector<OpenCell> path_;  ///< By level.
  std::uint64_t code_ = 0, cells_ = 0;
  /// The values of the cells of a subtree, which the encoder gets together.
  int block_level_;
  std::vector<Value8> block_;
};

/// Returns the colours of all cells of a DAG. `add_all` gives CellColors those of the voxels, at
/// least one for each. `color_bound` is the largest error of a colour (AttributeOptions). The
/// budget no longer counts the result when the function returns. Throws OverMemory, and what
/// `add_all` throws.
DagAttributes encode_cell_colors(const SvdagView& dag, double color_bound, MemoryBudget* memory,
                                 const std::function<void(CellColors&)>& add_all);

}  // namespace voxdag
