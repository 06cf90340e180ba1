#pragma once
/// The options of exports, and the rules that all exports follow.
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>

#include "voxdag/core/grid.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/stored/attributes/look.hpp"
#include "voxdag/stored/svdag/voxel_set.hpp"

namespace voxdag {

/// Exports write the voxels of a DAG, or the finest ones of an ESVO, to the formats of other
/// programs. They need less than 100 MiB of memory, whatever the size of the output. A file
/// that is larger than the free space of its disk is refused before anything is written. Outputs
/// appear when complete and depend on the voxels alone. On failure the functions throw
/// Error(path, place, reason). `grid` places the voxels in the world; grid.levels must equal
/// voxels.levels(). If the format cannot hold the placement, the functions write it beside the
/// output, as PATH.json, unless the output is a pipe or device.
struct ExportOptions {
  /// The voxels to export: a half-open box of voxel coordinates, inside the grid and not empty.
  /// Without it, all voxels.
  std::optional<Box3i> window;
  /// The colours, normals and materials of points, faces and lists of coordinates: those that the
  /// file of the voxels stores, or those of another file of the same mesh. Empty: none.
  LookView look;
  /// The greatest size of a dense array, in bytes; larger ones are refused before anything is
  /// written.
  std::uint64_t most_dense_bytes = std::uint64_t{16} << 30;
  /// Counts the grids of export_vdb(); may be null.
  MemoryBudget* memory = nullptr;
  /// Called from time to time with the fraction of the work and the number of voxels that are done.
  /// It may throw (Cancelled) to stop the export. While voxels are counted, both arguments are 0.
  std::function<void(double fraction, std::uint64_t voxels)> progress;
};

}  // namespace voxdag
