#include "edit/stamp_files.hpp"

#include <cmath>
#include <filesystem>

#include "cli/input_files.hpp"
#include "cli/mesh_input.hpp"
#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/solid/fill_solid.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/file/model/dag_model.hpp"
#include "voxdag/mesh/mesh_bounds.hpp"

namespace voxdag::cli {

PlacedStamp StampFiles::place(const StampRequest& request) {
  const StampPlace& place = request.place;
  const bool is_in_place = !place.at && place.orientation == Orientation{};
  const std::string key =
      (request.solid ? "solid " : "") + std::string(is_in_place ? "in place " : "") + request.file;
  auto found = stamps_.find(key);
  if (found == stamps_.end()) found = stamps_.emplace(key, read(request, is_in_place)).first;
  const Stamp& stamp = found->second;
  return place_stamp(stamp.dag.view(), stamp.grid, place, grid_, {&memory_, &session_.progress});
}

StampFiles::Stamp StampFiles::read(const StampRequest& request, bool is_in_place) {
  const std::filesystem::path path = request.file;
  check_not_overwritten(outputs_, {&path, 1}, "the script");
  if (!is_container(request.file)) return read_mesh(request, is_in_place);
  if (request.solid) throw Error(request.file, "", "is no mesh: only meshes can be filled");
  const Work work(&memory_, &session_.progress);
  const DagModel model(path, work);
  return {place_stamp(model.view(), model.grid(), {}, model.grid(), work).voxels, model.grid()};
}

StampFiles::Stamp StampFiles::read_mesh(const StampRequest& request, bool is_in_place) {
  MeshAccess access;
  access.memory = &memory_;
  access.outputs = outputs_;
  const Mesh mesh = read_mesh_file(request.file, access, session_);
  const Work work(&memory_, &session_.progress);
  Grid grid = grid_;
  if (!is_in_place) {  // A grid around the mesh, whose voxels coincide with those of the DAG.
    const Box3d bounds = referenced_bounds(mesh);
    Vec3d lo = grid_.to_grid(bounds.lo);
    for (int axis = 0; axis < 3; ++axis) lo[axis] = std::floor(lo[axis]);
    const double side = grid_.voxel_size;  // A point on the upper side of the box has a voxel, too.
    grid = grid_from_bounds(Box3d{grid_.to_world(lo), bounds.hi + Vec3d{side, side, side}}, side);
  }
  Svdag dag = build_svdag(mesh, grid, BuildMethod::kHashConsed, work).dag;
  if (request.solid) dag = fill_solid(dag.view(), mesh, grid, {}, work);
  return {std::move(dag), grid};
}

}  // namespace voxdag::cli
