#pragma once
/// Chooses the grid of a build or an import.
///
/// 1. The box is the bounding box of the mesh, or `bounds`. `origin` replaces its lower corner;
///    `snap` moves that corner down to multiples of voxel_size.
/// 2. The grid starts at the lower corner of the box. Its voxels have the size voxel_size, or the
///    longest side of the box has resolution - 2 * padding voxels.
/// 3. `padding` and `center` move the grid by whole voxels: along each axis, the box starts at
///    voxel `padding`, or lies in the middle. The grid has the least 2^L voxels a side that hold
///    the box and the padding on both sides.
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "voxdag/core/grid.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// Voxels along the longest side of meshes and points if the user does not say it.
inline constexpr std::int64_t kDefaultResolution = 1024;

/// The resolution or the voxel size of a grid, and its place.
struct GridRequest {
  /// Voxels along the longest side, 1 to 2^kMaxLevels. Either this or voxel_size is given.
  std::optional<std::int64_t> resolution = {};
  std::optional<double> voxel_size = {};  ///< World units.
  std::optional<Box3d> bounds = {};       ///< World units. Default: those of the mesh.
  std::optional<Vec3d> origin = {};       ///< World units. Default: lower corner of the bounds.
  bool snap = false;                      ///< Needs voxel_size.
  std::int64_t padding = 0;               ///< Empty voxels on each side of the box.
  bool center = false;                    ///< Whether the box lies in the middle, not at `padding`.
};

/// Returns the grid for a mesh. Throws Error if there is none: see grid_mapping.hpp.
Grid grid_for(const Mesh& mesh, const GridRequest& request);
/// Returns the grid for a mesh with these bounds: of the vertices that its triangles use.
Grid grid_for(const Box3d& mesh_bounds, const GridRequest& request);

/// Applies step 3 to a grid whose box takes `used` voxels along each axis, from voxel 0 on. Throws
/// Error if the result has more than 2^kMaxLevels voxels a side.
Grid with_margins(Grid grid, Vec3l used, const GridRequest& request);

/// Returns the entries of VdagMetadata::build that say how the grid was chosen.
std::map<std::string, std::string> settings_of(const GridRequest& request);

}  // namespace voxdag
