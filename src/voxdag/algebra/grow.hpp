#pragma once
/// Grows and shrinks bodies: dilation and erosion.
///
/// Source of the operations: Serra, "Image Analysis and Mathematical Morphology", 1982.
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/core/vec.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// Which voxels are neighbours.
enum class Neighbours {
  k6,   ///< Those that share a face.
  k26,  ///< Those that share a face, an edge or a corner.
};

/// Returns the minimal DAG, in canonical order, of all voxels of the grid that are `steps` steps
/// from neighbour to neighbour or less away from a voxel of `dag`: a cube (k26) or an octahedron
/// (k6) around each voxel. `dag` must be valid and steps >= 0. Throws Error if the result outgrows
/// 32-bit pointers, OverMemory and Cancelled.
Svdag dilate(const SvdagView& dag, int steps, Neighbours neighbours, Work work = {});

/// Returns the minimal DAG, in canonical order, of all voxels v of the grid for which `dag` has a
/// voxel p with |v - p| <= half along each axis. Components of `half` are at least 0. See dilate()
/// for the rest.
Svdag dilate_box(const SvdagView& dag, Vec3i half, Work work = {});

/// Returns the minimal DAG, in canonical order, of the voxels of `dag` that are more than `steps`
/// steps away from every place without a voxel. All places outside the grid are without voxels.
/// See dilate() for the rest.
Svdag erode(const SvdagView& dag, int steps, Neighbours neighbours, Work work = {});

}  // namespace voxdag
