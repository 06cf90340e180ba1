#pragma once
/// Values of voxels, sorted in bounded memory.
#include <cstdint>
#include <filesystem>

#include "voxdag/algebra/voxels/morton_builder.hpp"
#include "voxdag/algebra/voxels/sorted_records.hpp"
#include "voxdag/algebra/voxels/voxel_builder.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// A voxel, by its Morton code, and one of its values.
template <class T>
struct VoxelRecord {
  std::uint64_t code = 0;
  T value{};

  friend auto operator<=>(const VoxelRecord&, const VoxelRecord&) = default;
};

/// Takes values of voxels in any order; a voxel may have many.
template <class T>
class VoxelRecords {
 public:
  /// A grid of 2^levels voxels a side. Holds up to `most` records in memory; files lie in `folder`.
  /// Throws OverMemory.
  VoxelRecords(int levels, std::size_t most, const std::filesystem::path& folder, Work work)
      : levels_(levels), memory_(work.memory), records_(most, folder, work) {}

  int levels() const { return levels_; }
  /// Throws Error if the voxel lies outside of the grid, or if a file cannot be written;
  /// OverMemory and Cancelled.
  void add(Vec3i voxel, T value) { records_.add({code_in_grid(voxel, levels_), value}); }
  /// Calls visit(record) in ascending order of voxels, then values. Throws Error if a file cannot
  /// be read, Cancelled, and what `visit` throws.
  template <class Visit>
  void visit_all(const Visit& visit) {
    records_.visit_all(visit);
  }
  /// Returns the DAG of all voxels. Throws as visit_all(), and OverMemory.
  Svdag make_dag() {
    MortonBuilder builder(levels_, memory_);
    visit_all([&](const VoxelRecord<T>& record) { builder.add(record.code); });
    return builder.finish();
  }

 private:
  int levels_;
  MemoryBudget* memory_;
  SortedRecords<VoxelRecord<T>, Repeats::kKept> records_;
};

}  // namespace voxdag
