#include "voxdag/algebra/query/surface_area.hpp"

#include "voxdag/algebra/combine.hpp"
#include "voxdag/algebra/shift.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"

namespace voxdag {

VoxelSurface surface_of(const SvdagView& dag, Work work) {
  VoxelSurface surface;
  if (dag.is_empty()) return surface;
  surface.voxels = count_svdag(dag).voxels;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3i step;
    step[axis] = 1;
    const Svdag moved = shift(dag, step, dag.levels, work);
    const Svdag pairs = combine(dag, moved.view(), SetOperation::kIntersection, work);
    const std::uint64_t neighbours = pairs.view().is_empty() ? 0 : count_svdag(pairs.view()).voxels;
    surface.faces[axis] = 2 * (surface.voxels - neighbours);
  }
  return surface;
}

}  // namespace voxdag
