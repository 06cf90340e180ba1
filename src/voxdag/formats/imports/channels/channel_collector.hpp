#pragma once
/// Collects the values of a channel of voxels.
#include <filesystem>

#include "voxdag/algebra/attributes/channel_of_voxels.hpp"
#include "voxdag/formats/imports/voxel_records.hpp"

namespace voxdag {

/// Collects values of voxels, in any order; a voxel may have many. It gets their mean, summed in
/// ascending order in double and rounded by channel_code(). Memory is bounded, but for 4 bytes for
/// each voxel and each cell in encode().
class ChannelCollector {
 public:
  /// A grid of 2^levels voxels a side. Holds up to `most_values` in memory, 16 bytes each; files
  /// lie in `folder`. Throws OverMemory.
  ChannelCollector(int levels, ChannelSpec spec, std::size_t most_values,
                   const std::filesystem::path& folder, Work work)
      : spec_(std::move(spec)), work_(work), records_(levels, most_values, folder, work) {}

  /// Adds a value of a voxel. Throws Error if the voxel lies outside of the grid, for values that
  /// the channel's kind does not have, or if a file cannot be written; OverMemory and Cancelled.
  void add(Vec3i voxel, double value);
  /// Returns the DAG of all voxels. Throws as VoxelRecords::make_dag().
  Svdag make_dag() { return records_.make_dag(); }
  /// Returns the channel of all cells of that DAG, which `index` numbers. Throws Error if a file
  /// cannot be read; OverMemory and Cancelled.
  EncodedChannel encode(const SvdagView& dag, const CellIndexView& index);

 private:
  ChannelSpec spec_;
  Work work_;
  VoxelRecords<double> records_;
};

}  // namespace voxdag
