#pragma once
/// Compares a caster with the scalar one, ray by ray, on every instruction set of the machine.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/test_rays.hpp"
#include "voxdag/trace/esvo_cast.hpp"
#include "voxdag/trace/scalar_caster.hpp"

namespace voxdag {

inline bool same_hit(const CellHit& a, const CellHit& b) {
  return a.t == b.t && a.x == b.x && a.y == b.y && a.z == b.z && a.level == b.level;
}

inline bool same_hit(const EsvoHit& a, const EsvoHit& b) {
  return same_hit(static_cast<const CellHit&>(a), static_cast<const CellHit&>(b)) &&
         a.voxel.slot == b.voxel.slot && a.voxel.child == b.voxel.child &&
         a.plane.contour == b.plane.contour &&
         (!a.is_through_contour() || a.plane.level == b.plane.level);
}

/// The results of a caster for each ray.
template <class Found>
struct CastResults {
  std::vector<Found> hits;
  std::vector<char> is_hit;
};

template <class Found, class Caster>
CastResults<Found> closest_hits(const Caster& caster, const std::vector<CastRay>& rays) {
  CastResults<Found> results{std::vector<Found>(rays.size()), std::vector<char>(rays.size())};
  caster.closest(
      static_cast<int>(rays.size()), [&](int i) { return rays[static_cast<std::size_t>(i)]; },
      [&](int i, const GridRay&, const Found& hit, bool is_hit) {
        results.hits[static_cast<std::size_t>(i)] = hit;
        results.is_hit[static_cast<std::size_t>(i)] = is_hit ? 1 : 0;
      });
  return results;
}

/// Casts with references to the rays; closest_hits() passes copies.
template <class Caster>
std::vector<char> any_hits(const Caster& caster, const std::vector<CastRay>& rays) {
  std::vector<char> results(rays.size());
  caster.any(
      static_cast<int>(rays.size()),
      [&](int i) -> const CastRay& { return rays[static_cast<std::size_t>(i)]; },
      [&](int i, bool is_hit) { results[static_cast<std::size_t>(i)] = is_hit ? 1 : 0; });
  return results;
}

/// Expects the hits of the scalar caster, and returns them.
template <class Nodes, class Caster>
CastResults<typename FoundBy<Nodes>::Type> expect_same_hits(const Nodes& nodes,
                                                            const Caster& caster,
                                                            const std::vector<CastRay>& rays,
                                                            const std::string& what) {
  using Found = typename FoundBy<Nodes>::Type;
  const auto expected = closest_hits<Found>(ScalarCaster<Nodes>(nodes), rays);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    const auto found = closest_hits<Found>(caster, rays);
    const auto met = any_hits(caster, rays);
    int wrong = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const bool is_same = found.is_hit[i] == expected.is_hit[i] && met[i] == expected.is_hit[i] &&
                           (expected.is_hit[i] == 0 || same_hit(found.hits[i], expected.hits[i]));
      wrong += is_same ? 0 : 1;
    }
    EXPECT_EQ(wrong, 0) << "of " << rays.size() << " rays, " << what << ", "
                        << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
  return expected;
}

/// Returns a grid of unit voxels.
inline Grid grid_of(int levels) {
  Grid grid;
  grid.levels = levels;
  return grid;
}

/// Returns `count` rays of every kind; t_min and t_max lie inside and outside of the grid.
inline std::vector<CastRay> rays_of_every_kind(const Grid& grid, int count, unsigned seed) {
  TestRays make(grid, seed);
  std::vector<CastRay> rays;
  for (int i = 0; i < count; ++i)
    for (int kind = 0; kind < static_cast<int>(RayKind::kCount); ++kind)
      rays.push_back({make_grid_ray(grid, make.make(static_cast<RayKind>(kind))), {}});
  return rays;
}

/// Gives the rays random levels of detail: cells of up to `at_start`, growing by up to `per_t` per
/// T.
inline void set_random_stops(std::vector<CastRay>& rays, float at_start, float per_t,
                             unsigned seed) {
  for (CastRay& ray : rays) {
    seed = seed * 1664525u + 1013904223u;
    ray.stop.at_start = static_cast<float>(seed >> 16 & 0xFFu) / 256 * at_start;
    ray.stop.per_t = static_cast<float>(seed >> 24) / 256 * per_t;
  }
}

/// Returns bundles of rays like the primary rays of 8×8 pixels after a beam. The rays of a bundle
/// have a common origin and start at one distance from it. They end at cells of up to six times
/// `size_per_t`.
inline std::vector<CastRay> ray_bundles(const Grid& grid, double width, double size_per_t) {
  const auto n = static_cast<double>(grid.resolution());
  std::vector<CastRay> rays;
  for (int bundle = 0; bundle < 300; ++bundle) {
    const double a = bundle * 0.7, b = bundle * 0.31;
    const Vec3d eye =
        Vec3d{0.5 + 0.4 * std::sin(a), 0.5 + 0.3 * std::cos(b), 0.5 + 0.2 * std::sin(a + b)} * n;
    for (int i = 0; i < 64; ++i) {
      const Vec3d direction{std::cos(a) + width * (i % 8), std::sin(b) + width * (i / 8), 0.3};
      CastRay ray;
      ray.ray = make_grid_ray(grid, eye, direction, bundle % 40 * 0.01 * n, HUGE_VAL);
      ray.stop = stop_below_size(grid, ray.ray, size_per_t * (bundle % 7));
      rays.push_back(ray);
    }
  }
  return rays;
}

/// Returns rays as ambient occlusion casts them: 64 short rays from each point. Every third point
/// lies on a plane between cells.
inline std::vector<CastRay> short_rays_of_points(const Grid& grid, int points) {
  std::vector<CastRay> rays;
  unsigned seed = 5;
  const auto number = [&] {
    seed = seed * 1664525u + 1013904223u;
    return static_cast<float>(seed >> 8) * 0x1p-24f;
  };
  const auto cells = static_cast<unsigned>(grid.resolution());
  for (int point = 0; point < points; ++point) {
    GridPoint start{{1 + number(), 1 + number(), 1 + number()}};
    if (point % 3 == 0)
      start.position.x = 1 + static_cast<float>(seed % cells) / static_cast<float>(cells);
    for (int i = 0; i < 64; ++i) {
      const Vec3f direction{number() - 0.5f, number() - 0.5f, number() - 0.5f};
      rays.push_back({make_grid_ray(start, direction, i % 5 == 0 ? 0.1f * number() : 0.0f,
                                    0.2f * number() + 0.1f),
                      {}});
    }
  }
  return rays;
}

}  // namespace voxdag
