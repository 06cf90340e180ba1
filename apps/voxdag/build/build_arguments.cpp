#include "build/build_arguments.hpp"

#include "voxdag/voxelize/grid_mapping.hpp"

namespace voxdag {

Grid choose_grid(const Mesh& mesh, const std::optional<Box3d>& surface,
                 const BuildArguments& arguments) {
  if (arguments.bounds || surface) {
    const Box3d& bounds = arguments.bounds ? *arguments.bounds : *surface;
    return arguments.levels ? grid_from_bounds(bounds, *arguments.levels)
                            : grid_from_bounds(bounds, *arguments.voxel_size);
  }
  return arguments.levels ? fit_grid(mesh, *arguments.levels)
                          : grid_from_voxel_size(mesh, *arguments.voxel_size);
}

std::map<std::string, std::string> grid_settings(const BuildArguments& arguments) {
  return {{"cover", "exact"},
          {"grid_from", arguments.bounds ? "bounds" : "mesh"},
          {"scale_from", arguments.levels ? "resolution" : "voxel_size"}};
}

}  // namespace voxdag
