#include "voxdag/edit/place_stamp.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "voxdag/algebra/query/voxel_moments.hpp"
#include "voxdag/algebra/reorient.hpp"
#include "voxdag/algebra/shift.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/number_text.hpp"

namespace voxdag {

PlacedStamp place_stamp(const SvdagView& stamp, const Grid& stamp_grid, const StampPlace& place,
                        const Grid& grid, Work work) {
  const Svdag turned = reorient(stamp, place.orientation, work);
  const Box3i box = bounds_of(turned.view(), work);
  const Vec3i size = box.hi - box.lo;
  const double off = std::abs(stamp_grid.voxel_size / grid.voxel_size - 1);
  if (!(off * std::max({size.x, size.y, size.z, 1}) <= 1e-3))
    throw Error("the stamp's voxels have sides of " + number_text(stamp_grid.voxel_size) +
                ", and those of the DAG " + number_text(grid.voxel_size));
  const Vec3i source_lo = bounds_of(stamp, work).lo;
  const Vec3d corner = grid.to_grid(place.at.value_or(stamp_grid.to_world(Vec3d(source_lo))));
  Vec3i lo;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(std::abs(corner[axis] - box.lo[axis]) < 0x1p20))
      throw Error("the stamp lies a million voxels or more away");
    lo[axis] = static_cast<std::int32_t>(std::lround(corner[axis]));
  }
  return {shift(turned.view(), lo - box.lo, grid.levels, work), {lo, lo + size}};
}

}  // namespace voxdag
