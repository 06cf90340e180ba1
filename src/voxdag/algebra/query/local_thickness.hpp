#pragma once
/// The local thickness of bodies.
#include <cstdint>

#include "voxdag/core/box.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// The squares of the thicknesses in voxels, whole numbers, of the places of a box.
struct LocalThickness {
  Box3i box;  ///< All voxels lie in it.
  /// Place box.lo + (x, y, z) has squares[x + nx (y + ny z)], where nx and ny are the box's sizes;
  /// an empty place has 0.
  CountedVector<std::uint32_t> squares;
};

/// Returns the thickness of each voxel: the diameter of the largest ball that holds the centre of
/// the voxel, has its own centre in the centre of a voxel, and whose inside meets no empty place.
/// All places outside of the grid are empty. A plate of n voxels has the thickness n if n is odd,
/// and n - 1 if it is even, because no voxel has its centre in the middle. Reserves 8 bytes per
/// place of the box and more for the balls; the time grows with their volumes. Throws Error if the
/// voxels have a diagonal of more than 32,767, OverMemory and Cancelled.
///
/// Source: T. Hildebrand, P. Ruegsegger, "A new method for the model-independent assessment of
/// thickness in three-dimensional images", 1997.
LocalThickness local_thickness(const SvdagView& dag, Work work = {});

}  // namespace voxdag
