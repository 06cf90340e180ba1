#pragma once
/// The grid that a user asks for.
#include <map>
#include <optional>
#include <string>

#include "voxdag/core/grid.hpp"
#include "voxdag/mesh/mesh.hpp"

namespace voxdag {

/// A resolution or a voxel size, and where the grid lies.
struct GridRequest {
  std::optional<int> levels;         ///< Either this or voxel_size.
  std::optional<double> voxel_size;  ///< World units.
  std::optional<Box3d> bounds;       ///< Without it, the grid lies around the mesh.
};

/// Returns the grid for a mesh. Throws Error if there is none: see grid_mapping.hpp.
Grid grid_for(const Mesh& mesh, const GridRequest& request);
/// Returns the grid for a mesh with these bounds: of the vertices that its triangles use.
Grid grid_for(const Box3d& mesh_bounds, const GridRequest& request);

/// Returns the entries of VdagMetadata::build that say how the grid was chosen.
std::map<std::string, std::string> settings_of(const GridRequest& request);

}  // namespace voxdag
