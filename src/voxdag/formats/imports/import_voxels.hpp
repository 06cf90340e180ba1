#pragma once
/// Builds DAGs from files of voxels and points.
#include <optional>

#include "voxdag/builders/attributes/build_attributes.hpp"
#include "voxdag/builders/voxelize/grid_request.hpp"
#include "voxdag/core/box.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/formats/imports/voxel_source.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// How Gaussian splats set voxels (docs/splats.md).
struct SplatOptions {
  /// Above 0, below 1: a voxel of this opacity is set. Default: 0.1.
  std::optional<double> opacity = {};
  /// The least standard deviation along an axis, in world units. Default: half a voxel.
  std::optional<double> min_scale = {};
  /// Splats with a standard deviation of this or more, in world units, are left out. Default: the
  /// greatest power of two that is not above 1/64 of the longest side of `bounds`, or of the box of
  /// the centres.
  std::optional<double> max_scale = {};
};

/// The grid is for points; of voxels, `resolution` is the least side of the grid, and `voxel_size`
/// and `origin` are for those without a place.
struct ImportOptions : GridRequest {
  bool colors = true;  ///< Stores the colours of files that have some.
  /// AttributeOptions::color_bound. Default: 0.05; 0 for sources with a palette.
  std::optional<double> color_bound;
  /// Numbers or names of labels. Not empty: voxels and points with other labels are left out, or
  /// with `drops`, those with these.
  std::vector<std::string> labels;
  bool drops_labels = false;
  std::filesystem::path folder;  ///< Of files for sorting.
  SplatOptions splats;
};

/// Returns the color_bound of an import.
inline double color_bound_of(const VoxelSource& source, const ImportOptions& options) {
  return options.color_bound.value_or(source.has_palette() ? 0 : 0.05);
}

struct ImportResult {
  Svdag dag;
  DagAttributes attributes;  ///< Colours, labels and channels of all cells, if there are any.
  /// The label and the name of each material, if the source has labels: names are unique, those of
  /// labels without a name are their numbers.
  std::vector<Label> labels;
  std::vector<std::string> label_names;
  Grid grid;
  std::uint64_t read = 0;      ///< Points or voxels in the file.
  std::uint64_t outside = 0;   ///< Points outside of the bounds, which are left out.
  std::uint64_t unwanted = 0;  ///< Points or voxels that ImportOptions::labels leaves out.
  /// Points with NaN or infinite coordinates, and splats with such numbers or without a rotation,
  /// which are left out.
  std::uint64_t not_finite = 0;
  std::uint64_t too_large = 0;  ///< Splats that SplatOptions::max_scale leaves out.
  SplatOptions splats;          ///< The options that were used, if the source has splats.
};

/// Sets the voxel of each point (see PointLocator), or each voxel. Points need exactly one of
/// `resolution` and `voxel_size`. Without `bounds` and with `resolution`, the grid is that of their
/// bounding box, as for a mesh, and points on its upper sides belong to the last voxels. Without
/// `bounds`, `origin` and `snap` and with `voxel_size`, the grid begins half a voxel below the
/// least coordinates, so that points of a lattice lie in the middle of their voxels. Voxels need
/// neither: without `resolution` the grid is that of the file, or the smallest one with its corner
/// at 0 that holds them. Reads the file once or twice; memory is bounded. Throws Error, OverMemory
/// and Cancelled. Voxels of sources without a place lie in a grid of `voxel_size` (default 1) with
/// its corner at `origin` (default 0). Voxels get the
/// labels that LabelCollector gives them, and the channels that ChannelCollector does. Splats set
/// voxels by `splats`; their grid is placed around the boxes of the splats, as for a mesh.
ImportResult import_voxels(const VoxelSource& source, const ImportOptions& options, Work work = {});

}  // namespace voxdag
