#pragma once
/// A face, or a rectangle of faces, as a polygon that is cut into triangles.
#include <array>
#include <cstdint>
#include <vector>

#include "voxdag/formats/exports/faces/rectangles.hpp"

namespace voxdag {

struct FacePolygon {
  Face face = Face::kNone;
  Value8 color{};                                       ///< sRGB encoded.
  std::vector<Vec3d> corners;                           ///< In voxel coordinates.
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< Counter-clockwise from outside.
  // Only manifolds set these:
  Vec3i voxel;                     ///< The voxel of the face.
  std::vector<std::uint8_t> uses;  ///< The number of faces that have each corner.
};

/// Sets `polygon` to a rectangle of two triangles.
void set_rectangle(const FaceRectangle& rectangle, FacePolygon& polygon);

/// Sets `polygon` to a rectangle of w x h faces whose sides are cut at each voxel, so that no
/// corner of another rectangle lies inside one of its edges: 2 (w + h) - 2 triangles.
void set_cut_rectangle(const FaceRectangle& rectangle, FacePolygon& polygon);

}  // namespace voxdag
