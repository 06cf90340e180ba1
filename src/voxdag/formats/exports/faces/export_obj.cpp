#include <array>
#include <cmath>
#include <string>

#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/formats/exports/coordinates.hpp"
#include "voxdag/formats/exports/faces/export_faces.hpp"
#include "voxdag/formats/exports/faces/exported_rectangles.hpp"

namespace voxdag {
namespace {

template <class T>
void append(std::string& line, const Vec3<T>& v) {
  for (int axis = 0; axis < 3; ++axis) line.append(" ").append(shortest(v[axis]));
}

/// Returns the texts of the colours 0 to 255: from 0 to 1, with as many digits as tell them apart.
std::array<std::string, 256> channel_texts() {
  std::array<std::string, 256> texts;
  for (std::size_t i = 0; i < texts.size(); ++i)
    texts[i] = shortest(static_cast<float>(std::round(static_cast<double>(i) / 255 * 1e4) / 1e4));
  return texts;
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
  const bool use_float = float_suffices(grid);
  const std::array<std::string, 256> channels = channel_texts();
  std::uint64_t corner = 1;
  rectangles.for_each([&](const FaceRectangle& rectangle) {
    text.clear();
    const Value8 color = rectangle.color;
    for (const Vec3i place : corners_of(rectangle)) {
      text.append("v");
      const Vec3d world = grid.to_world(Vec3d(place));
      if (use_float)
        append(text, Vec3f(world));
      else
        append(text, world);
      if (rectangles.has_colors())
        for (const std::uint8_t channel : {color.x, color.y, color.z})
          text.append(" ").append(channels[channel]);
      text.append("\n");
    }
    // Some readers skip quads.
    for (const std::array<int, 3> triangle : {std::array{0, 1, 2}, {0, 2, 3}}) {
      text.append("f");
      for (const int i : triangle)
        text.append(" ").append(std::to_string(corner + static_cast<std::uint64_t>(i)));
      text.append("\n");
    }
    corner += 4;
    file.write(text);
  });
  file.commit();
}

}  // namespace voxdag
