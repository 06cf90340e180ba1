#include <vector>

#include "voxdag/formats/scenes/builder.hpp"
#include "voxdag/formats/scenes/list.hpp"

/// The Menger sponge: a cube of 3^depth cells a side, without the cells whose base-3 coordinates
/// have two ones at the same digit. It has outer faces only. Every coordinate is a multiple of a
/// power of two, so nothing is rounded. The side is between 0.5 m and 1 m.
namespace voxdag::scenes {
namespace {

bool is_solid(int x, int y, int z, int cells) {
  if (x < 0 || y < 0 || z < 0 || x >= cells || y >= cells || z >= cells) return false;
  for (; x > 0 || y > 0 || z > 0; x /= 3, y /= 3, z /= 3)
    if ((x % 3 == 1) + (y % 3 == 1) + (z % 3 == 1) >= 2) return false;
  return true;
}

int sponge_cells(double size) {
  int cells = 1;
  for (int i = 0; i < static_cast<int>(size); ++i) cells *= 3;
  return cells;
}

double sponge_cell(int cells) {
  double cell = 1;
  while (cell * cells > 1) cell /= 2;
  return cell;
}

}  // namespace

Mesh make_sponge(double size, std::uint32_t, Work work) {
  const int cells = sponge_cells(size);
  const double cell = sponge_cell(cells);
  Builder builder(work);
  builder.material("sponge");
  // Vertices of the two planes around a layer of cells: neighbouring cells share them.
  constexpr std::uint32_t kNone = ~0u;
  const int stride = cells + 1;
  std::vector<std::uint32_t> planes[2];
  for (auto& plane : planes) plane.assign(static_cast<std::size_t>(stride) * stride, kNone);
  for (int z = 0; z < cells; ++z) {
    const auto corner = [&](int x, int y, int dz) {
      std::uint32_t& index = planes[dz][static_cast<std::size_t>(y) * stride + x];
      if (index == kNone) index = builder.vertex(Vec3d{x * cell, y * cell, (z + dz) * cell});
      return index;
    };
    for (int y = 0; y < cells; ++y)
      for (int x = 0; x < cells; ++x) {
        if (!is_solid(x, y, z, cells)) continue;
        for (int axis = 0; axis < 3; ++axis)
          for (int side = 0; side < 2; ++side) {
            Vec3i next{x, y, z};
            next[axis] += side == 0 ? -1 : 1;
            if (is_solid(next.x, next.y, next.z, cells)) continue;
            // Counter-clockwise from outside: the near side has the reverse order of the far side.
            std::uint32_t v[4];
            for (int i = 0; i < 4; ++i) {
              const int turn = side == 1 ? i : 3 - i;
              Vec3i d{};
              d[axis] = side;
              d[(axis + 1) % 3] = turn == 1 || turn == 2;
              d[(axis + 2) % 3] = turn >= 2;
              v[i] = corner(x + d.x, y + d.y, d.z);
            }
            builder.quad(v[0], v[1], v[2], v[3]);
          }
      }
    planes[0].swap(planes[1]);
    planes[1].assign(planes[1].size(), kNone);
  }
  return builder.take();
}

ScenePreset sponge_preset(double size) {
  const double side = sponge_cell(sponge_cells(size)) * sponge_cells(size);
  ScenePreset preset;
  preset.eye = Vec3d{1.7, 1.35, 2.2} * side;
  preset.target = Vec3d{0.5, 0.36, 0.5} * side;
  preset.fov_degrees = 42;
  preset.sun_direction = normalized(Vec3d{-0.35, 0.9, 0.62});
  // The flight goes in through the hole in front, and backwards out at the side.
  preset.flight = {{0, preset.eye, preset.target},
                   {3, Vec3d{0.85, 0.85, 1.9} * side, Vec3d{0.5, 0.5, 0.5} * side},
                   {6, Vec3d{0.5, 0.5, 1.25} * side, Vec3d{0.5, 0.5, 0} * side},
                   {9, Vec3d{0.5, 0.5, 0.68} * side, Vec3d{0.38, 0.5, 0.15} * side},
                   {12, Vec3d{0.62, 0.5, 0.5} * side, Vec3d{-0.1, 0.5, 0.46} * side},
                   {15, Vec3d{1.2, 0.55, 0.52} * side, Vec3d{0.3, 0.5, 0.5} * side},
                   {18, Vec3d{1.75, 0.95, 1.2} * side, Vec3d{0.5, 0.46, 0.5} * side},
                   {21, preset.eye, preset.target}};
  return preset;
}

}  // namespace voxdag::scenes
