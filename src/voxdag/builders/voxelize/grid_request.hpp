#pragma once
/// The grid that a user asks for.
#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "voxdag/core/grid.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// A resolution or a voxel size, and where the grid lies.
struct GridRequest {
  /// Voxels along the longest side, 1 to 2^kMaxLevels: a box in the least grid that holds it.
  /// Either this or voxel_size.
  std::optional<std::int64_t> resolution = {};
  std::optional<double> voxel_size = {};  ///< World units.
  std::optional<Box3d> bounds = {};       ///< Without it, the grid lies around the mesh.
  std::optional<Vec3d> origin = {};  ///< Lower corner of the grid, instead of that of the mesh.
  bool snap = false;         ///< The origin is a multiple of voxel_size, which must be given.
  std::int64_t padding = 0;  ///< Empty voxels on each side, which count towards `resolution`.
  bool center = false;       ///< The content lies in the middle of the grid, to a whole voxel.
};

/// Returns the grid for a mesh. Throws Error if there is none: see grid_mapping.hpp.
Grid grid_for(const Mesh& mesh, const GridRequest& request);
/// Returns the grid for a mesh with these bounds: of the vertices that its triangles use.
Grid grid_for(const Box3d& mesh_bounds, const GridRequest& request);

/// Returns `grid` with the padding that the request asks for, centred and on multiples of the voxel
/// size if it asks for that. The content takes `used` voxels along each axis, from voxel 0 on.
/// Throws Error if the result has more than 2^kMaxLevels voxels a side.
Grid with_margins(Grid grid, Vec3l used, const GridRequest& request);

/// Returns the entries of VdagMetadata::build that say how the grid was chosen.
std::map<std::string, std::string> settings_of(const GridRequest& request);

}  // namespace voxdag
