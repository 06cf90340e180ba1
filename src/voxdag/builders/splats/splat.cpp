#include "voxdag/builders/splats/splat.hpp"

#include <algorithm>
#include <cmath>

namespace voxdag {
namespace {

/// Returns the axes of the splat, vectors of length 1.
std::array<Vec3d, 3> axes_of(const std::array<float, 4>& rotation) {
  const double w = rotation[0], x = rotation[1], y = rotation[2], z = rotation[3];
  const double s = 2 / (((w * w + x * x) + y * y) + z * z);
  return {{{1 - s * (y * y + z * z), s * (x * y + w * z), s * (x * z - w * y)},
           {s * (x * y - w * z), 1 - s * (x * x + z * z), s * (y * z + w * x)},
           {s * (x * z + w * y), s * (y * z - w * x), 1 - s * (x * x + y * y)}}};
}

/// Returns half of the sides of the box of an ellipsoid.
Vec3d half_box(const std::array<Vec3d, 3>& axes, const std::array<double, 3>& radii) {
  Vec3d half;
  for (int axis = 0; axis < 3; ++axis) {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const double part = axes[k][axis] * radii[k];
      sum += part * part;
    }
    half[axis] = std::sqrt(sum);
  }
  return half;
}

}  // namespace

Splat splat_of_logarithms(const std::array<float, 4>& rotation,
                          const std::array<float, 3>& log_scale, float opacity) {
  Splat splat{rotation, {}, 0};
  for (std::size_t k = 0; k < 3; ++k)
    splat.scale[k] = static_cast<float>(std::exp(static_cast<double>(log_scale[k])));
  // a = 1 / (1 + exp(-opacity)), so -ln(1 - a) = ln(1 + exp(opacity)).
  const double extinction = std::log1p(std::exp(static_cast<double>(opacity)));
  splat.extinction = static_cast<float>(extinction);
  if (extinction > kMaxExtinction) splat.extinction = kMaxExtinction;
  return splat;
}

float extinction_of(double opacity) {
  const double extinction = -std::log1p(-opacity);
  return extinction > kMaxExtinction ? kMaxExtinction : static_cast<float>(extinction);
}

bool is_usable(const Splat& splat) {
  bool has_rotation = false;
  for (const float part : splat.rotation) {
    if (!std::isfinite(part)) return false;
    has_rotation |= part != 0;
  }
  for (const float scale : splat.scale)
    if (!std::isfinite(scale)) return false;
  return has_rotation && std::isfinite(splat.extinction);
}

GridSplat grid_splat(const Splat& splat, Vec3d center, double voxel_size, double min_scale,
                     std::int32_t side) {
  const std::array<Vec3d, 3> axes = axes_of(splat.rotation);
  GridSplat placed;
  placed.center = center;
  placed.extinction = static_cast<double>(splat.extinction) * kExtinctionUnits;
  std::array<double, 3> reach{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double scale = std::max(static_cast<double>(splat.scale[k]), min_scale) / voxel_size;
    reach[k] = kSplatReach * scale;
    for (int axis = 0; axis < 3; ++axis) placed.rows[k][axis] = axes[k][axis] / scale;
  }
  const Vec3d half = half_box(axes, reach);
  for (int axis = 0; axis < 3; ++axis) {
    const auto in_grid = [&](double at) {
      return static_cast<std::int32_t>(std::clamp(at, 0.0, static_cast<double>(side)));
    };
    placed.box.lo[axis] = in_grid(std::floor(center[axis] - half[axis]));
    placed.box.hi[axis] = in_grid(std::ceil(center[axis] + half[axis]) + 1);
  }
  return placed;
}

Vec3d reach_of(const Splat& splat) {
  std::array<double, 3> reach{};
  for (std::size_t k = 0; k < 3; ++k) reach[k] = kSplatReach * static_cast<double>(splat.scale[k]);
  return half_box(axes_of(splat.rotation), reach);
}

bool misses(const GridSplat& splat, const Box3i& voxels) {
  // Rounding errors of u are far below this.
  constexpr double kSlack = 0.01;
  for (const Vec3d& row : splat.rows) {
    double middle = 0, half = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double lo = voxels.lo[axis], hi = voxels.hi[axis] - 1;
      middle += row[axis] * ((lo + hi) / 2 - splat.center[axis]);
      half += std::abs(row[axis]) * ((hi - lo) / 2);
    }
    if (std::abs(middle) - half > kSplatReach + kSlack) return true;
  }
  return false;
}

}  // namespace voxdag
