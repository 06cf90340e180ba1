#include "voxdag/formats/exports/faces/face_polygon.hpp"

namespace voxdag {

void set_rectangle(const FaceRectangle& rectangle, FacePolygon& polygon) {
  polygon.face = rectangle.face;
  polygon.color = rectangle.color;
  polygon.corners.clear();
  for (const Vec3i corner : corners_of(rectangle)) polygon.corners.push_back(Vec3d(corner));
  polygon.triangles = {{0, 1, 2}, {0, 2, 3}};
}

void set_cut_rectangle(const FaceRectangle& rectangle, FacePolygon& polygon) {
  set_rectangle(rectangle, polygon);
  const std::array<Vec3i, 4> ends = corners_of(rectangle);
  // The corners go round the rectangle: `width` steps, `height` steps, and back.
  const auto steps = [&](std::size_t side) {
    const Vec3i along = ends[side + 1] - ends[side];
    return static_cast<std::uint32_t>(std::abs(along.x) + std::abs(along.y) + std::abs(along.z));
  };
  const std::uint32_t width = steps(0), height = steps(1);
  if (width == 1 && height == 1) return;
  polygon.corners.clear();
  for (std::size_t side = 0; side < 4; ++side) {
    const std::uint32_t count = side % 2 == 0 ? width : height;
    const Vec3d from(ends[side]), step = (Vec3d(ends[(side + 1) % 4]) - from) * (1.0 / count);
    for (std::uint32_t i = 0; i < count; ++i)
      polygon.corners.push_back(from + step * static_cast<double>(i));
  }
  const auto low = [&](std::uint32_t x) { return x; };
  const auto high = [&](std::uint32_t x) { return 2 * width + height - x; };
  const auto left = [&](std::uint32_t y) { return y == 0 ? 0 : 2 * width + 2 * height - y; };
  const auto right = [&](std::uint32_t y) { return width + y; };
  auto& triangles = polygon.triangles;
  triangles.clear();
  // A fan over the left side, a strip between the low and the high side, a fan over the right side.
  for (std::uint32_t y = 0; y < height; ++y) triangles.push_back({low(1), left(y + 1), left(y)});
  for (std::uint32_t x = 1; x < width; ++x) {
    triangles.push_back({low(x), low(x + 1), high(x)});
    triangles.push_back({low(x), high(x), high(x - 1)});
  }
  for (std::uint32_t y = 0; y < height; ++y)
    triangles.push_back({high(width - 1), right(y), right(y + 1)});
}

}  // namespace voxdag
