#pragma once
/// Builds a DAG from voxels in any order.
#include <filesystem>
#include <span>

#include "voxdag/algebra/voxels/sorted_records.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/core/vec.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// Throws the Error that a voxel lies outside of a grid of 2^levels voxels a side.
[[noreturn]] void throw_outside_of_grid(Vec3i voxel, int levels);

/// Returns the Morton code of a voxel. Throws Error if it lies outside of a grid of 2^levels voxels
/// a side.
inline std::uint64_t code_in_grid(Vec3i voxel, int levels) {
  // The sign bit of a negative coordinate is a high bit.
  if (static_cast<std::uint32_t>(voxel.x | voxel.y | voxel.z) >> levels != 0)
    throw_outside_of_grid(voxel, levels);
  return morton_encode(voxel);
}

/// Collects voxels, each any number of times, and builds their DAG. Memory is bounded: voxels that
/// do not fit are sorted in a file, and the DAG is built from the sorted ones node by node.
class VoxelBuilder {
 public:
  /// A grid of 2^levels voxels a side. Holds up to `most_voxels` in memory, 8 bytes each; the file
  /// of the others lies in `folder`. Throws OverMemory.
  VoxelBuilder(int levels, std::size_t most_voxels, const std::filesystem::path& folder,
               Work work = {});

  /// Adds a voxel. Throws Error if it lies outside of the grid, or if a file cannot be written;
  /// Cancelled.
  void add(Vec3i voxel) { codes_.add(code_in_grid(voxel, levels_)); }
  /// Returns the minimal DAG, in canonical order. Call it last. Throws Error if it outgrows 32-bit
  /// pointers or a file cannot be read; OverMemory and Cancelled.
  Svdag finish();

  /// Returns the number of sorted runs in the file; 0 if all voxels fit into memory.
  std::size_t runs() const { return codes_.runs(); }

 private:
  int levels_;
  MemoryBudget* memory_;
  SortedRecords<std::uint64_t, Repeats::kDropped> codes_;
};

/// Returns the minimal DAG, in canonical order, of voxels whose Morton codes ascend. Throws Error
/// if it outgrows 32-bit pointers, and OverMemory.
Svdag svdag_of_sorted(int levels, std::span<const std::uint64_t> codes, MemoryBudget* memory);

}  // namespace voxdag
