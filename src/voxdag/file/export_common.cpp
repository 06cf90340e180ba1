#include "voxdag/file/export_common.hpp"

#include <nlohmann/json.hpp>

#include "voxdag/core/error.hpp"
#include "voxdag/io/atomic_file.hpp"

namespace voxdag {

Box3i export_window(const std::filesystem::path& path, const VoxelSet& voxels,
                    const ExportOptions& options) {
  const Box3i grid = whole_grid(voxels.levels());
  if (!options.window) return grid;
  const Box3i& window = *options.window;
  for (int axis = 0; axis < 3; ++axis) {
    if (window.lo[axis] >= window.hi[axis])
      throw Error(path.string(), "window", "is empty: each end must be greater than its start");
    if (window.lo[axis] < 0 || window.hi[axis] > grid.hi[axis])
      throw Error(path.string(), "window",
                  "extends beyond the grid of " + std::to_string(grid.hi.x) + " voxels a side");
  }
  return window;
}

void write_placement(const std::filesystem::path& path, const Grid& grid, const Box3i& window,
                     const ArrayLayout& layout) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return;
  const Vec3i lo = window.lo, hi = window.hi;
  nlohmann::ordered_json json;
  json["grid"] = {{"resolution", grid.resolution()},
                  {"origin", {grid.origin.x, grid.origin.y, grid.origin.z}},
                  {"voxel_size", grid.voxel_size}};
  json["window"] = {{"lo", {lo.x, lo.y, lo.z}}, {"hi", {hi.x, hi.y, hi.z}}};
  json["array"] = {{"content", layout.content}, {"dtype", layout.dtype}};
  if (!layout.axes.empty()) {
    json["array"]["axes_slowest_to_fastest"] = layout.axes;
    for (const char axis : layout.axes)
      json["array"]["shape"].push_back(hi[axis - 'x'] - lo[axis - 'x']);
  }
  json["placement"] =
      std::string(
          "voxel (i, j, k) is the cube from grid.origin + (i, j, k) * grid.voxel_size, "
          "grid.voxel_size wide") +
      (layout.axes.empty() ? "" : "; the array's first element is voxel window.lo");

  AtomicFile file(path.string() + ".json");
  file.write(json.dump(2, ' ', false, decltype(json)::error_handler_t::replace) + "\n");
  file.commit();
}

}  // namespace voxdag
