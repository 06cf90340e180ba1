#include "voxdag/formats/exports/export_common.hpp"

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>

#include "voxdag/core/error.hpp"
#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/core/io/resolved_output.hpp"
#include "voxdag/formats/export_placement.hpp"
#include "voxdag/formats/exports/count_voxels.hpp"

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

namespace {

/// Returns the free bytes on the disk of a file. Returns the largest number for a pipe or device,
/// or if the system reports none.
std::uint64_t free_bytes(const std::filesystem::path& path) {
  constexpr std::uint64_t kUnlimited = std::numeric_limits<std::uint64_t>::max();
  std::error_code unknown;
  const ResolvedOutput output = resolve_output(path);
  const auto kind = std::filesystem::status(output.file, unknown).type();
  if (output.descriptor >= 0 || (kind != std::filesystem::file_type::not_found &&
                                 kind != std::filesystem::file_type::regular))
    return kUnlimited;
  const std::filesystem::space_info space = std::filesystem::space(
      std::filesystem::absolute(output.file, unknown).parent_path(), unknown);
  return unknown ? kUnlimited : space.available;
}

[[noreturn]] void refuse_size(const std::filesystem::path& path, const std::string& need,
                              std::uint64_t space) {
  throw Error(path.string(), "",
              "needs " + need + " bytes, more than the " + std::to_string(space) +
                  " bytes that are free on its disk: choose a smaller window");
}

}  // namespace

void check_disk_space(const std::filesystem::path& path, std::uint64_t bytes) {
  if (const std::uint64_t space = free_bytes(path); bytes > space)
    refuse_size(path, std::to_string(bytes), space);
}

std::uint64_t count_for_export(const std::filesystem::path& path, const VoxelSet& voxels,
                               const Box3i& window, std::uint64_t bytes_per_voxel,
                               const ExportOptions& options) {
  const std::uint64_t space = free_bytes(path);
  const std::uint64_t most = bytes_per_voxel == 0 ? std::numeric_limits<std::uint64_t>::max() - 1
                                                  : space / bytes_per_voxel;
  const std::uint64_t count =
      count_voxels(voxels, window, std::min(most, std::numeric_limits<std::uint64_t>::max() - 1),
                   [&] { report_export(options, 0, 1); });
  if (count > most) refuse_size(path, "at least " + std::to_string(count * bytes_per_voxel), space);
  return count;
}

void refuse_export(const std::filesystem::path& path, const std::string& reason) {
  throw Error(path.string(), "",
              reason + ": choose a smaller --window, or make a coarser grid (voxdag coarsen)");
}

void refuse_pipe(const std::filesystem::path& path) {
  std::error_code ignored;
  if (std::filesystem::is_fifo(path, ignored))
    throw Error(path.string(), "",
                "is a pipe, but this format is completed at its beginning: choose a file");
}

void write_placement(const std::filesystem::path& path, const Grid& grid, const Box3i& window,
                     const ArrayLayout& layout, const ExportOptions& options) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) return;
  write_placement_file(path.string() + ".json", grid, window, layout, options);
}

void remove_placement(const std::filesystem::path& path) {
  const std::filesystem::path beside = path.string() + ".json";
  std::error_code ignored;
  if (!read_placement(beside).is_null()) std::filesystem::remove(beside, ignored);
}

void write_placement_file(const std::filesystem::path& path, const Grid& grid, const Box3i& window,
                          const ArrayLayout& layout, const ExportOptions& options) {
  const Vec3i lo = window.lo, hi = window.hi;
  nlohmann::ordered_json json;
  json["grid"] = {{"resolution", grid.resolution()},
                  {"origin", {grid.origin.x, grid.origin.y, grid.origin.z}},
                  {"voxel_size", grid.voxel_size}};
  json["window"] = {{"lo", {lo.x, lo.y, lo.z}}, {"hi", {hi.x, hi.y, hi.z}}};
  if (layout.lo_in_file) {
    const Vec3i& first = *layout.lo_in_file;
    json["window"]["lo_in_file"] = {first.x, first.y, first.z};
  }
  json["array"] = {{"content", layout.content}, {"dtype", layout.dtype}};
  if (!layout.axes.empty()) {
    json["array"]["axes_slowest_to_fastest"] = layout.axes;
    for (const char axis : layout.axes)
      json["array"]["shape"].push_back(hi[axis - 'x'] - lo[axis - 'x']);
  }
  if (layout.has_numbered_slices) json["array"]["slices"] = "numbered";
  if (layout.offset) json["offset"] = {layout.offset->x, layout.offset->y, layout.offset->z};
  if (const auto& turn = options.turn)
    json["turned"] = {{"up", std::string(1, turn->up)},
                      {"from_up", std::string(1, turn->from_up)},
                      {"origin_before", {turn->origin.x, turn->origin.y, turn->origin.z}}};
  json["placement"] =
      std::string(
          "voxel (i, j, k) is the cube from grid.origin + (i, j, k) * grid.voxel_size, "
          "grid.voxel_size wide") +
      (layout.axes.empty() ? "" : "; the array's first element is voxel window.lo");

  AtomicFile file(path);
  file.write(json.dump(2, ' ', false, decltype(json)::error_handler_t::replace) + "\n");
  file.commit();
}

}  // namespace voxdag
