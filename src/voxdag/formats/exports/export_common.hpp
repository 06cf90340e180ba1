#pragma once
/// The window, progress calls and placement file that the exporters share.
#include <string>

#include "voxdag/formats/exports/export_options.hpp"

namespace voxdag {

/// Returns the requested window, or the whole grid. Throws Error(path, "window", reason) if it is
/// empty or extends beyond the grid.
Box3i export_window(const std::filesystem::path& path, const VoxelSet& voxels,
                    const ExportOptions& options);

/// Returns the number of voxels in the window. Throws Error(path, ...) if that number times
/// `bytes_per_voxel` does not fit on the disk of `path`.
std::uint64_t count_for_export(const std::filesystem::path& path, const VoxelSet& voxels,
                               const Box3i& window, std::uint64_t bytes_per_voxel,
                               const ExportOptions& options);

/// Throws Error(path, ...) if a file of this many bytes does not fit on the disk of `path`. Pipes
/// and devices have no limit.
void check_disk_space(const std::filesystem::path& path, std::uint64_t bytes);

/// Throws Error(path, "", `reason` and what the user can do about it): the format has a limit.
[[noreturn]] void refuse_export(const std::filesystem::path& path, const std::string& reason);

/// Throws Error if the output is a pipe: for formats that are completed at their beginning.
void refuse_pipe(const std::filesystem::path& path);

/// Reports that `done` of `count` voxels are done to options.progress, if it is set.
inline void report_export(const ExportOptions& options, std::uint64_t done, std::uint64_t count) {
  if (options.progress)
    options.progress(count == 0 ? 1 : static_cast<double>(done) / static_cast<double>(count), done);
}

/// Runs for_each_leaf_block(), and reports the voxels that are done (of `count`) to
/// options.progress.
template <class Fn>
void export_leaf_blocks(const VoxelSet& voxels, const Box3i& window, std::uint64_t count,
                        const ExportOptions& options, const Fn& fn) {
  std::uint64_t done = 0, blocks = 0;
  voxels.for_each_leaf_block(window, [&](Vec3i origin, std::uint64_t mask) {
    fn(origin, mask);
    done += static_cast<std::uint64_t>(popcount64(mask));
    if (++blocks % 16384 == 0) report_export(options, done, count);
  });
}

/// The content of an exported array, for PATH.json.
struct ArrayLayout {
  std::string content;  ///< The meaning of an element or row, in words.
  std::string dtype;
  /// The axes of a dense array, from the slowest to the fastest; empty for others.
  std::string axes;
  /// The coordinates that the file gives voxel window.lo. Default: (0, 0, 0) in a dense array,
  /// window.lo in other files.
  std::optional<Vec3i> lo_in_file = {};
  std::optional<Vec3d> offset = {};  ///< What must be added to the coordinates of the file.
  /// The numbers in the names of slices tell their places, because empty ones are left out.
  bool has_numbered_slices = false;
};

/// Writes PATH.json: the grid, the window, the layout, how they place a voxel in the world, and
/// options.turn.
/// Writes nothing if `path` is a pipe or device.
void write_placement(const std::filesystem::path& path, const Grid& grid, const Box3i& window,
                     const ArrayLayout& layout, const ExportOptions& options);

/// Removes PATH.json if an earlier export wrote it: the placement of a file that is no more.
void remove_placement(const std::filesystem::path& path);

/// Writes the placement to `file`.
void write_placement_file(const std::filesystem::path& file, const Grid& grid, const Box3i& window,
                          const ArrayLayout& layout, const ExportOptions& options);

}  // namespace voxdag
