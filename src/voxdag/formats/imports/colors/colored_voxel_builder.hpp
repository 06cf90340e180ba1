#pragma once
/// Builds a DAG with colours from voxels in any order.
#include <filesystem>

#include "voxdag/algebra/voxels/sorted_records.hpp"
#include "voxdag/builders/attributes/build_attributes.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/formats/imports/voxel_source.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// Which colour a voxel gets that has several.
enum class ColorRule : std::uint8_t { kMean, kLast };

/// A voxel and one of its colours.
struct ColoredCode {
  std::uint64_t code = 0;
  std::uint32_t number = 0;  ///< For ColorRule::kLast: its place in the file, at most 2^32 - 1.
  std::uint32_t color = 0;   ///< Red in the lowest byte, then green and blue.

  friend auto operator<=>(const ColoredCode&, const ColoredCode&) = default;
};

/// Like VoxelBuilder, with colours; a voxel may have many. Memory is bounded.
class ColoredVoxelBuilder {
 public:
  /// A grid of 2^levels voxels a side. Holds up to `most_colors` in memory, 16 bytes each; files
  /// lie in `folder`. Throws OverMemory.
  ColoredVoxelBuilder(int levels, std::size_t most_colors, const std::filesystem::path& folder,
                      Work work, ColorRule rule = ColorRule::kMean);

  /// Adds a colour of a voxel. Throws Error if it lies outside of the grid, or if a file cannot be
  /// written; OverMemory and Cancelled.
  void add(Vec3i voxel, Rgb8 color);

  struct Result {
    Svdag dag;                 ///< Minimal and in canonical order.
    DagAttributes attributes;  ///< Colours of all cells.
  };
  /// Call it last. `color_bound` is the largest error of a colour (AttributeOptions). The budget no
  /// longer counts the result when the function returns. Throws Error if the DAG outgrows 32-bit
  /// pointers or a file cannot be read; OverMemory and Cancelled.
  Result finish(double color_bound);

 private:
  int levels_;
  MemoryBudget* memory_;
  ColorRule rule_;
  std::uint32_t added_ = 0;
  SortedRecords<ColoredCode, Repeats::kKept> colors_;
};

}  // namespace voxdag
