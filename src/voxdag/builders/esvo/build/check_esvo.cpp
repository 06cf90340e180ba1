#include "voxdag/builders/esvo/build/check_esvo.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <vector>

#include "voxdag/builders/pieces/triangle_source.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/core/parallel/parallel_for.hpp"

namespace voxdag {
namespace {

constexpr std::uint64_t kSamplesAtOnce = 1 << 18;  // samples

/// Returns a random number for each counter value, by splitmix64.
std::uint64_t mix(std::uint64_t v) {
  v += 0x9E3779B97F4A7C15ull;
  v = (v ^ v >> 30) * 0xBF58476D1CE4E5B9ull;
  v = (v ^ v >> 27) * 0x94D049BB133111EBull;
  return v ^ v >> 31;
}

double unit(std::uint64_t bits) { return static_cast<double>(bits >> 11) * 0x1p-53; }

/// Walks down to a point and records the deepest level that it reached.
struct Walk {
  const EsvoView& esvo;
  Vec3d point;  // in voxels
  int deepest = 0;

  static constexpr double kSlack = 1e-6;  // voxels

  bool is_inside(std::uint64_t slot, int level, Vec3i cell) {
    const ChildDescriptor d = esvo.descriptor(slot);
    const double half = 0.5 * static_cast<double>(std::int64_t{1} << (esvo.levels - level - 1));
    deepest = std::max(deepest, level);
    for (int child = 0; child < 8; ++child) {
      if ((d.valid_mask() >> child & 1) == 0) continue;
      const Vec3i at = cell * 2 + Vec3i{child & 1, child >> 1 & 1, child >> 2};
      // The point in the child's own coordinates, in which it is [-1,1]³.
      Vec3d local;
      bool in_cube = true;
      for (int axis = 0; axis < 3; ++axis) {
        local[axis] = point[axis] / half - 2.0 * at[axis] - 1;
        in_cube &= std::fabs(local[axis]) <= 1 + kSlack / half;
      }
      if (!in_cube || !is_in_contour(slot, d, child, local, half)) continue;
      if ((d.leaf_mask() >> child & 1) != 0 || is_inside(esvo.child(slot, d, child), level + 1, at))
        return true;
    }
    return false;
  }

  bool is_in_contour(std::uint64_t slot, ChildDescriptor d, int child, Vec3d local,
                     double half) const {
    if ((d.contour_mask() >> child & 1) == 0) return true;
    const Contour contour = esvo.contour(slot, d, child);
    const Vec3i n = contour.normal();
    const std::int32_t n1 = length1(n);
    const double at = dot(static_cast<Vec3d>(n), local), slack = n1 * kSlack / half;
    return at >= contour_position<double>(n1, contour.low()) - slack &&
           at <= contour_position<double>(n1, contour.high()) + slack;
  }
};

}  // namespace

EnclosureCheck check_enclosure(const EsvoView& esvo, const QuantizedMesh& mesh, const Grid& grid,
                               const SurfaceShading* shading, const DisplacedTriangles* displaced,
                               std::uint64_t samples, std::uint64_t seed, Work work) {
  const std::size_t count = mesh.triangle_count();
  std::vector<double> area_before(count + 1);
  const auto corners = [&](std::size_t i, Vec3d(&p)[3]) {
    const QuantizedTriangle t = mesh.triangle(i);
    for (int k = 0; k < 3; ++k) p[k] = static_cast<Vec3d>(t[k]) * (1.0 / kSubvoxels);
  };
  for (std::size_t i = 0; i < count; ++i) {
    double area = 0;
    if (mesh.in_range(i)) {
      Vec3d p[3];
      corners(i, p);
      const Vec3d n = cross(p[1] - p[0], p[2] - p[0]);
      area = std::sqrt(dot(n, n)) + 1e-9;
    }
    area_before[i + 1] = area_before[i] + area;
  }

  EnclosureCheck result;
  std::atomic<std::uint64_t> looked_at{0}, first_bad{~std::uint64_t{0}};
  std::mutex mutex;
  const double size = static_cast<double>(std::int64_t{1} << esvo.levels);
  const auto look_at = [&](std::uint64_t i) {
    const std::uint64_t a = mix(seed * 0x10001 + 3 * i), b = mix(a), c = mix(b);
    // Half of the samples are spread by area, half by triangle.
    std::size_t triangle = i / 2 % count;
    if (i % 2 == 0) {
      const auto at =
          std::upper_bound(area_before.begin(), area_before.end(), unit(c) * area_before.back());
      triangle =
          std::min<std::size_t>(static_cast<std::size_t>(at - area_before.begin()), count) - 1;
    }
    if (!mesh.in_range(triangle)) return;
    const std::uint32_t source = mesh.source(triangle);
    const bool is_displaced = displaced != nullptr && displaced->is_displaced(source);
    // A displaced triangle is sampled as a whole, not by the pieces that clipping at the grid's
    // sides makes.
    if (is_displaced && source != triangle) return;
    Vec3d p[3];
    corners(triangle, p);
    double u = unit(a), v = unit(b);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    // Some samples are corners or lie on edges.
    if (i % 16 == 1) u = static_cast<double>(a & 1), v = u > 0 ? 0 : static_cast<double>(b & 1);
    if (i % 16 == 3) v = 0;
    Vec2f place{static_cast<float>(u), static_cast<float>(v)};
    if (is_displaced) {
      const MicroTriangle micro = displaced->micro_at(source, place, displaced_edge_limit(grid));
      for (std::size_t k = 0; k < 3; ++k) {
        const std::optional<Vec3i> q = quantize(grid, micro.positions[k]);
        if (!q) return;
        p[k] = static_cast<Vec3d>(*q) * (1.0 / kSubvoxels);
      }
      // A random point of the micro triangle.
      u = unit(mix(c)), v = unit(mix(c + 1));
      if (u + v > 1) u = 1 - u, v = 1 - v;
      const std::array<Vec2f, 3>& corner = micro.barycentrics;
      place = corner[0] + (corner[1] - corner[0]) * static_cast<float>(u) +
              (corner[2] - corner[0]) * static_cast<float>(v);
    }
    const Vec3d point = p[0] + (p[1] - p[0]) * u + (p[2] - p[0]) * v;
    for (int axis = 0; axis < 3; ++axis)
      if (!(point[axis] >= 0 && point[axis] < size)) return;
    if (shading != nullptr) {
      const Vec2f at[1] = {place};
      if (source == triangle && shading->is_alpha_masked(source, at)) return;
    }
    looked_at.fetch_add(1, std::memory_order_relaxed);
    Walk walk{esvo, point};
    if (!esvo.is_empty() && walk.is_inside(esvo.root, 0, {})) return;
    const std::lock_guard lock(mutex);
    if (i >= first_bad.load()) return;
    first_bad = i;
    result.outside = PointOutside{source, point, walk.deepest + 1};
  };
  for (std::uint64_t left = samples; left > 0;) {
    const std::uint64_t begin = samples - left, now = std::min(left, kSamplesAtOnce);
    left -= now;
    work.poll();
    work.report("enclosure", static_cast<double>(begin) / static_cast<double>(samples));
    parallel_for(now, 1024, [&](std::size_t i) { look_at(begin + i); });
  }
  result.points = looked_at;
  return result;
}

}  // namespace voxdag
