#include <string>

#include "voxdag/exports/coordinates.hpp"
#include "voxdag/exports/faces/export_faces.hpp"
#include "voxdag/exports/faces/exported_rectangles.hpp"
#include "voxdag/io/atomic_file.hpp"

namespace voxdag {
namespace {

void append(std::string& line, const Vec3d& v) {
  for (int axis = 0; axis < 3; ++axis) line.append(" ").append(shortest(v[axis]));
}

}  // namespace

void export_obj(const std::filesystem::path& path, const VoxelSet& voxels, const Grid& grid,
                const ExportOptions& options) {
  const Box3i window = export_window(path, voxels, options);
  ExportedRectangles rectangles(voxels, window, options, true);
  AtomicFile file(path);
  std::string text = "# made by voxdag\n# grid_origin";
  append(text, grid.origin);
  text.append("\n# voxel_size ").append(shortest(grid.voxel_size));
  text.append("\n# resolution ").append(std::to_string(grid.resolution())).append("\n");
  file.write(text);
  std::uint64_t corner = 1;
  rectangles.for_each([&](const FaceRectangle& rectangle) {
    text.clear();
    const Value8 color = rectangle.color;
    for (const Vec3i place : corners_of(rectangle)) {
      text.append("v");
      append(text, grid.to_world(Vec3d(place)));
      if (rectangles.has_colors())
        append(text, {color.x / 255.0, color.y / 255.0, color.z / 255.0});
      text.append("\n");
    }
    text.append("f");
    for (int i = 0; i < 4; ++i) text.append(" ").append(std::to_string(corner++));
    file.write(text.append("\n"));
  });
  file.commit();
}

}  // namespace voxdag
