#pragma once
/// The outer faces of voxels, merged to rectangles.
///
/// Each plane between two layers of voxels is swept row by row. A run of faces continues a
/// rectangle if the row before has a run of equal ends and colour. So rectangles are as long as
/// possible along rows, then as high as possible. A corner of one rectangle can lie inside the edge
/// of another.
#include <cstdint>
#include <functional>

#include "voxdag/formats/exports/export_options.hpp"
#include "voxdag/stored/attributes/look_reader.hpp"
#include "voxdag/trace/hit.hpp"

namespace voxdag {

/// A rectangle of outer faces of voxels, which have one colour.
struct FaceRectangle {
  Face face = Face::kNone;
  Vec3i lo{}, hi{};  ///< Its corners, in voxel coordinates; equal on the axis of the face.
  Value8 color{};    ///< sRGB encoded; black without colours.
};

/// Calls fn for the outer faces of the voxels in the half-open `window`: those whose neighbour is
/// no voxel of the window. Their order depends on the voxels alone. With `colors`, which may be
/// null, only faces of one colour are merged. If not `merge`, each face is a rectangle of its own.
/// Holds less than 70 MiB, and the runs of two rows. `progress` is called from time to time with
/// the fraction that is done.
void for_each_rectangle(const VoxelSet& voxels, const Box3i& window, LookReader* colors, bool merge,
                        const std::function<void(double)>& progress,
                        const std::function<void(const FaceRectangle&)>& fn);

/// Returns the corners of a rectangle, counter-clockwise from outside.
std::array<Vec3i, 4> corners_of(const FaceRectangle& rectangle);

}  // namespace voxdag
