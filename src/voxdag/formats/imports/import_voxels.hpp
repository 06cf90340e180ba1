#pragma once
/// Builds DAGs from files of voxels and points.
#include <optional>

#include "voxdag/builders/attributes/build_attributes.hpp"
#include "voxdag/core/box.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/formats/imports/voxel_source.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

struct ImportOptions {
  std::optional<int> levels;         ///< log2 of the voxels per side.
  std::optional<double> voxel_size;  ///< World units; for points.
  std::optional<Box3d> bounds;       ///< For points: what the grid holds.
  bool colors = true;                ///< Stores the colours of files that have some.
  double color_bound = 0.05;         ///< AttributeOptions::color_bound
  std::filesystem::path folder;      ///< Of files for sorting.
};

struct ImportResult {
  Svdag dag;
  DagAttributes attributes;  ///< Colours of all cells, if there are any.
  Grid grid;
  std::uint64_t read = 0;     ///< Points or voxels in the file.
  std::uint64_t outside = 0;  ///< Points outside of the bounds, which are left out.
};

/// Sets the voxel of each point, or each voxel. Points need exactly one of `levels` and
/// `voxel_size`; without `bounds` the grid is that of their bounding box, as for a mesh, and points
/// on its upper sides belong to the last voxels. Voxels need neither: without `levels` the grid is
/// that of the file, or the smallest one with its corner at 0 that holds them. Reads the file once
/// or twice; memory is bounded. Throws Error, OverMemory and Cancelled.
ImportResult import_voxels(const VoxelSource& source, const ImportOptions& options, Work work = {});

}  // namespace voxdag
