#pragma once
/// Distances from the places of a window to the nearest voxel or the nearest empty place.
#include <cstdint>
#include <limits>
#include <vector>

#include "voxdag/core/box.hpp"
#include "voxdag/core/memory_budget.hpp"
#include "voxdag/core/parallel/work.hpp"
#include "voxdag/stored/svdag/svdag.hpp"

namespace voxdag {

/// Sets distances[x - box.lo.x + nx (y - box.lo.y + ny (z - box.lo.z))] to the distance, in voxels,
/// from the centre of place (x, y, z) to the nearest voxel of the DAG, also outside of the box: to
/// its closed cube, 0 in a voxel, +infinity if the DAG is empty. `box` is not empty and may reach
/// out of the grid. Takes linear time if the box holds the grid, and reserves 4 bytes per place
/// beside the result. Throws OverMemory, Cancelled.
///
/// Source: A. Meijster, J. Roerdink, W. Hesselink, "A General Algorithm for Computing Distance
/// Transforms in Linear Time", 2000, here for distances to cubes.
std::vector<float> distance_field(const SvdagView& dag, const Box3i& box, Work work);

/// As distance_field(), but negative in voxels: there the distance to the nearest empty place. All
/// places outside of the grid are empty.
std::vector<float> signed_distance_field(const SvdagView& dag, const Box3i& box, Work work);

inline constexpr std::uint32_t kNoSquare = std::numeric_limits<std::uint32_t>::max();

/// Returns for each place of the box, in the order of distance_field(), four times the square of
/// its depth in voxels, an exact whole number. The depth is the distance from its centre to the
/// closed cube of the nearest empty place in the box: 0 in empty places. All are kNoSquare if the
/// box has no empty place. Throws Error if the diagonal of the box has more than 32,767 places,
/// OverMemory and Cancelled.
CountedVector<std::uint32_t> depth_squares(const SvdagView& dag, const Box3i& box, Work work);

}  // namespace voxdag
