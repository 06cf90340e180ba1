#include "voxdag/builders/voxelize/grid_request.hpp"

#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/mesh/mesh_bounds.hpp"

namespace voxdag {

Grid grid_for(const Mesh& mesh, const GridRequest& request) {
  return grid_for(request.bounds ? Box3d::empty() : referenced_bounds(mesh), request);
}

Grid grid_for(const Box3d& mesh_bounds, const GridRequest& request) {
  if (request.bounds)
    return request.levels ? grid_from_bounds(*request.bounds, *request.levels)
                          : grid_from_bounds(*request.bounds, *request.voxel_size);
  return request.levels ? fit_grid(mesh_bounds, *request.levels)
                        : grid_from_voxel_size(mesh_bounds, *request.voxel_size);
}

std::map<std::string, std::string> settings_of(const GridRequest& request) {
  return {{"cover", "exact"},
          {"grid_from", request.bounds ? "bounds" : "mesh"},
          {"scale_from", request.levels ? "resolution" : "voxel_size"}};
}

}  // namespace voxdag
