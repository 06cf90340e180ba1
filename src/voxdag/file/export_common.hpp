#pragma once
/// What the exporters share: the window, the progress calls, the placement beside the output.
#include <string>

#include "voxdag/file/export.hpp"

namespace voxdag {

/// The window asked for, or the whole grid. Throws Error(path, "window", reason) if it is empty or
/// reaches out of the grid.
Box3i export_window(const std::filesystem::path& path, const VoxelSet& voxels,
                    const ExportOptions& options);

/// for_each_leaf_block that tells options.progress how many voxels were done, not too often.
template <class Fn>
void export_leaf_blocks(const VoxelSet& voxels, const Box3i& window, const ExportOptions& options,
                        const Fn& fn) {
  std::uint64_t done = 0, blocks = 0;
  voxels.for_each_leaf_block(window, [&](Vec3i origin, std::uint64_t mask) {
    fn(origin, mask);
    done += static_cast<std::uint64_t>(popcount64(mask));
    if (++blocks % 16384 == 0 && options.progress) options.progress(done);
  });
}

/// What an exported array holds, for PATH.json.
struct ArrayLayout {
  std::string content;  ///< Of one element or row, in words.
  std::string dtype;
  /// Of a dense array over the window: the axes from the slowest to the fastest. Else empty.
  std::string axes;
};

/// Writes PATH.json: grid, window, layout, and how they place a voxel in the world. Nothing where
/// `path` is a pipe or device.
void write_placement(const std::filesystem::path& path, const Grid& grid, const Box3i& window,
                     const ArrayLayout& layout);

}  // namespace voxdag
