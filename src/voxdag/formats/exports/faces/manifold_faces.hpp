#pragma once
/// The outer faces of voxels as a two-manifold.
///
/// Where voxels touch along an edge or at a corner only, their faces would share an edge of four
/// triangles, or a corner of several fans. There the edge gets a middle and the corner a copy for
/// each fan, and these move by 1/8 voxel into the voxels that they belong to. So bodies that only
/// touch come apart; all other corners stay on the lattice.
///
/// A smooth manifold has the same faces. Each corner moves towards the mean of the middles of the
/// faces of its fan, as in surface nets (S. F. F. Gibson, Constrained Elastic Surface Nets, 1998),
/// twice, and at most by a third of a voxel along each axis.
#include <functional>

#include "voxdag/formats/exports/faces/face_polygon.hpp"

namespace voxdag {

/// Calls fn(polygon) for the outer faces of the voxels in the half-open `window`, in the order of
/// the voxels. With `colors`, which may be null, polygons have colours. Calls
/// progress(voxels that are done) from time to time. Faces that share a corner have equal
/// coordinates for it, to the bit. Holds less than 1 MiB.
void for_each_manifold_face(const VoxelSet& voxels, const Box3i& window, LookReader* colors,
                            const std::function<void(std::uint64_t)>& progress,
                            const std::function<void(const FacePolygon&)>& fn, bool smooth = false);

}  // namespace voxdag
