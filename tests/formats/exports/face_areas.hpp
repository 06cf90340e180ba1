#pragma once
/// The areas of exported faces, and those that a scene has.
#include <cmath>
#include <cstring>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "voxdag/formats/exports/faces/rectangles.hpp"

namespace voxdag {

/// A triangle or quad: corners in voxel coordinates, and a colour (0 to 65535, linear).
struct ReadPolygon {
  std::vector<Vec3d> corners;
  Vec3i color{};
};

/// The area of the faces in each plane: by the axis across the plane, 1 or -1 for the direction
/// that the faces look in, and the plane's place.
using PlaneAreas = std::map<std::tuple<int, int, int>, double>;

/// Returns the areas of polygons across axes, whose corners are counter-clockwise from outside.
inline PlaneAreas areas_of(const std::vector<ReadPolygon>& polygons) {
  PlaneAreas areas;
  for (const ReadPolygon& p : polygons) {
    Vec3d normal{};
    for (std::size_t i = 1; i + 1 < p.corners.size(); ++i)
      normal = normal + cross(p.corners[i] - p.corners[0], p.corners[i + 1] - p.corners[0]) * 0.5;
    for (int axis = 0; axis < 3; ++axis)
      if (normal[axis] != 0)
        areas[{axis, normal[axis] > 0 ? 1 : -1,
               static_cast<int>(std::lround(p.corners[0][axis]))}] += std::abs(normal[axis]);
  }
  return areas;
}

/// Returns the areas of the outer faces of voxels.
inline PlaneAreas areas_of(const VoxelSet& voxels, const Box3i& window) {
  PlaneAreas areas;
  for_each_rectangle(voxels, window, nullptr, false, nullptr, [&](const FaceRectangle& r) {
    areas[{face_axis(r.face), dot(face_normal(r.face), Vec3i{1, 1, 1}), r.lo[face_axis(r.face)]}] +=
        1;
  });
  return areas;
}

/// Returns the value whose bytes begin at an offset.
template <class T>
T read_at(const std::string& bytes, std::size_t at) {
  T value;
  std::memcpy(&value, bytes.data() + at, sizeof value);
  return value;
}

}  // namespace voxdag
