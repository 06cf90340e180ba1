#include "voxdag/formats/exports/export_scene.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "voxdag/algebra/reorient.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/io/unpacked_name.hpp"
#include "voxdag/core/lower_case.hpp"
#include "voxdag/formats/export_placement.hpp"
#include "voxdag/formats/input_file.hpp"

namespace voxdag {
namespace {

Grid turned_grid(Grid grid, const Orientation& orientation) {
  const Vec3d before = grid.origin;
  const double side = grid.voxel_size * static_cast<double>(grid.resolution());
  for (int axis = 0; axis < 3; ++axis) {
    const double at = before[orientation.source_axis[axis]];
    grid.origin[axis] = orientation.is_flipped[axis] ? -(at + side) : at;
  }
  return grid;
}

Box3i turned_box(const Box3i& box, const Orientation& orientation, int levels) {
  const std::int32_t side = std::int32_t{1} << levels;
  Box3i turned;
  for (int axis = 0; axis < 3; ++axis) {
    const int from = orientation.source_axis[axis];
    const bool is_flipped = orientation.is_flipped[axis];
    turned.lo[axis] = is_flipped ? side - box.hi[from] : box.lo[from];
    turned.hi[axis] = is_flipped ? side - box.lo[from] : box.hi[from];
  }
  return turned;
}

}  // namespace

std::optional<char> up_of(const SceneMetadata& metadata) {
  if (const auto up = metadata.build.find("up"); up != metadata.build.end())
    return up->second == "y" || up->second == "z" ? std::optional(up->second[0]) : std::nullopt;
  const std::string name = lower_case(unpacked_name(metadata.source.name).string());
  for (const char* ending : {".glb", ".gltf"})
    if (name.ends_with(ending)) return 'y';
  for (const char* ending : {".vox", ".stl", ".3mf", ".las"})
    if (name.ends_with(ending)) return 'z';
  return std::nullopt;
}

std::vector<std::filesystem::path> export_scene(const std::filesystem::path& path,
                                                const VoxelSet& voxels,
                                                const SceneMetadata& metadata,
                                                const ExportContent& content, ExportOptions options,
                                                Work work) {
  const Grid& grid = metadata.grid;
  options.unit = metadata.presentation.unit;
  const std::optional<char> from = up_of(metadata), custom = custom_up(path, content);
  const std::optional<char> to = content.up ? content.up : from ? custom : std::nullopt;
  if (!to || from == to) return export_voxels(path, voxels, grid, content, options);
  const SvdagView* const dag = voxels.dag();
  if (dag == nullptr) {
    if (content.up)
      throw Error(path.string(), "",
                  "an ESVO cannot be turned: build a .vdag of its mesh, or leave out --up");
    if (options.notes != nullptr)
      options.notes->push_back(path.string() + ": is not turned, because it comes from an ESVO: " +
                               *from + " points up in it");
    return export_voxels(path, voxels, grid, content, options);
  }
  const char from_up = *to == 'z' ? 'y' : 'z';
  const Orientation orientation = turn_of_export(from_up);
  const Svdag turned = reorient(*dag, orientation, work);
  const MemoryReservation held(work.memory, turned.view().bytes());
  if (options.window) options.window = turned_box(*options.window, orientation, grid.levels);
  options.turn = {orientation, grid.origin, *to, from_up};
  return export_voxels(path, VoxelSet(turned.view()), turned_grid(grid, orientation), content,
                       options);
}

}  // namespace voxdag
