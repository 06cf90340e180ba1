#include "voxdag/builders/pieces/contour_direction.hpp"

#include <algorithm>

#include "voxdag/core/lanes.hpp"

namespace voxdag {

ContourDirection ContourDirection::nearest(Vec3d direction) {
  const double largest =
      std::max({std::fabs(direction.x), std::fabs(direction.y), std::fabs(direction.z)});
  if (!(largest > 0)) return {};
  const auto d = static_cast<Vec3f>(direction * (1 / largest));
  const auto rounded = [](FloatLanes v) { return truncated(v + 32.5f) - 32.0f; };
  // Longer vectors are more precise on average, but a shorter one may be closer to this direction.
  FloatLanes least = all_lanes(HUGE_VALF), x{}, y{}, z{};
  for (int most = Contour::kMaxNormal; most > Contour::kMaxNormal / 2; most -= kLanes) {
    const FloatLanes scale = static_cast<float>(most) - FloatLanes{0, 1, 2, 3};
    const FloatLanes nx = rounded(scale * d.x), ny = rounded(scale * d.y),
                     nz = rounded(scale * d.z);
    const FloatLanes cx = ny * d.z - nz * d.y, cy = nz * d.x - nx * d.z, cz = nx * d.y - ny * d.x;
    // The square of the sine.
    const FloatLanes off = (cx * cx + cy * cy + cz * cz) / (nx * nx + ny * ny + nz * nz);
    const IntLanes better = off < least;
    least = better ? off : least;
    x = better ? nx : x;
    y = better ? ny : y;
    z = better ? nz : z;
  }
  int best = 0;
  for (int lane = 1; lane < kLanes; ++lane)
    if (least[lane] < least[best]) best = lane;
  const Vec3i n{static_cast<std::int32_t>(x[best]), static_cast<std::int32_t>(y[best]),
                static_cast<std::int32_t>(z[best])};
  // Chooses the direction that points up, so that equal contours can be shared.
  const bool points_up = n.z != 0 ? n.z > 0 : n.y != 0 ? n.y > 0 : n.x > 0;
  return ContourDirection(points_up ? n : -n);
}

}  // namespace voxdag
