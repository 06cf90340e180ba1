// Packets against the scalar cast, ray by ray.
#include "voxdag/cpu/packet_caster.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <vector>

#include "support/brute_svdag.hpp"
#include "support/test_rays.hpp"
#include "support/voxel_sets.hpp"

namespace voxdag {
namespace {

struct Result {
  CellHit cell;
  bool is_hit = false;
};

bool same(const Result& a, const Result& b) {
  if (a.is_hit != b.is_hit) return false;
  return !a.is_hit || (a.cell.t == b.cell.t && a.cell.x == b.cell.x && a.cell.y == b.cell.y &&
                       a.cell.z == b.cell.z && a.cell.level == b.cell.level);
}

template <class Caster>
std::vector<Result> closest(const Caster& caster, const std::vector<CastRay>& rays) {
  std::vector<Result> results(rays.size());
  caster.closest(
      static_cast<int>(rays.size()), [&](int i) { return rays[static_cast<std::size_t>(i)]; },
      [&](int i, const GridRay&, const CellHit& cell, bool is_hit) {
        results[static_cast<std::size_t>(i)] = {cell, is_hit};
      });
  return results;
}

template <class Caster>
std::vector<char> any(const Caster& caster, const std::vector<CastRay>& rays) {
  std::vector<char> results(rays.size());
  caster.any(
      static_cast<int>(rays.size()), [&](int i) { return rays[static_cast<std::size_t>(i)]; },
      [&](int i, bool is_hit) { results[static_cast<std::size_t>(i)] = is_hit ? 1 : 0; });
  return results;
}

void expect_same_results(const SvdagNodes& nodes, const std::vector<CastRay>& rays,
                         const std::string& what) {
  const auto expected = closest(ScalarCaster<SvdagNodes>(nodes), rays);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(static_cast<std::uint32_t>(target));
    const auto found = closest(PacketCaster(nodes), rays);
    const auto met = any(PacketCaster(nodes), rays);
    int wrong = 0;
    for (std::size_t i = 0; i < rays.size(); ++i)
      wrong += !same(found[i], expected[i]) || (met[i] != 0) != expected[i].is_hit ? 1 : 0;
    EXPECT_EQ(wrong, 0) << "of " << rays.size() << " rays, " << what << ", "
                        << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
}

/// Rays of every kind, each with t_max and t_min in and out of the grid.
std::vector<CastRay> rays_of_every_kind(const Grid& grid, int count, unsigned seed) {
  TestRays make(grid, seed);
  std::vector<CastRay> rays;
  for (int i = 0; i < count; ++i)
    for (int kind = 0; kind < static_cast<int>(RayKind::kCount); ++kind)
      rays.push_back({make_grid_ray(grid, make.make(static_cast<RayKind>(kind))), {}});
  return rays;
}

TEST(PacketCaster, MeetsWhatTheScalarCastMeets) {
  for (const int levels : {2, 3, 5, 6}) {
    Grid grid;
    grid.levels = levels;
    const auto rays = rays_of_every_kind(grid, 300, 7);
    for (const NamedVoxels& set : voxel_sets(levels, 3)) {
      const Svdag dag = brute_svdag(levels, set.voxels);
      expect_same_results(SvdagNodes(dag.view()), rays, set.name);
    }
  }
}

TEST(PacketCaster, EndsAtTheSameLevelOfDetail) {
  const int levels = 6;
  Grid grid;
  grid.levels = levels;
  auto rays = rays_of_every_kind(grid, 300, 8);
  unsigned seed = 1;
  for (CastRay& ray : rays) {
    seed = seed * 1664525u + 1013904223u;
    ray.stop.at_start = static_cast<float>(seed >> 16 & 0xFFu) * 0x1p-13f;
    ray.stop.per_t = static_cast<float>(seed >> 24) * 0x1p-11f;
  }
  for (const NamedVoxels& set : voxel_sets(levels, 4)) {
    const Svdag dag = brute_svdag(levels, set.voxels);
    expect_same_results(SvdagNodes(dag.view()), rays, set.name);
  }
}

TEST(PacketCaster, RaysThatStartOnTheirWayEndAtTheSameLevelOfDetail) {
  const int levels = 7;
  Grid grid;
  grid.levels = levels;
  std::vector<CastRay> rays;
  // Bundles, as beams shorten them: all start after some way, close together.
  for (int bundle = 0; bundle < 200; ++bundle) {
    const double a = bundle * 0.7, b = bundle * 0.31;
    const Vec3d eye{64 + 50 * std::sin(a), 64 + 40 * std::cos(b), 64 + 30 * std::sin(a + b)};
    for (int i = 0; i < 64; ++i) {
      const Vec3d direction{std::cos(a) + 0.002 * (i % 8), std::sin(b) + 0.002 * (i / 8), 0.3};
      CastRay ray;
      ray.ray = make_grid_ray(grid, eye, direction, bundle % 40, HUGE_VAL);
      ray.stop = stop_below_size(grid, ray.ray, 0.01 * (bundle % 7));
      rays.push_back(ray);
    }
  }
  for (const NamedVoxels& set : voxel_sets(levels, 9)) {
    const Svdag dag = brute_svdag(levels, set.voxels);
    expect_same_results(SvdagNodes(dag.view()), rays, set.name);
  }
}

// As occlusion casts them: many short rays from one point, packed into the same packets.
TEST(PacketCaster, ShortRaysOfOnePointMeetTheSame) {
  const int levels = 7;
  Grid grid;
  grid.levels = levels;
  std::vector<CastRay> rays;
  unsigned seed = 5;
  const auto number = [&] {
    seed = seed * 1664525u + 1013904223u;
    return static_cast<float>(seed >> 8) * 0x1p-24f;
  };
  for (int point = 0; point < 100; ++point) {
    GridPoint start{{1 + number(), 1 + number(), 1 + number()}};
    if (point % 3 == 0) start.position.x = 1 + static_cast<float>(seed % 128u) / 128;
    for (int i = 0; i < 64; ++i) {
      const Vec3f direction{number() - 0.5f, number() - 0.5f, number() - 0.5f};
      rays.push_back({make_grid_ray(start, direction, i % 5 == 0 ? 0.1f * number() : 0.0f,
                                    0.2f * number() + 0.1f),
                      {}});
    }
  }
  for (const NamedVoxels& set : voxel_sets(levels, 6)) {
    const Svdag dag = brute_svdag(levels, set.voxels);
    expect_same_results(SvdagNodes(dag.view()), rays, set.name);
  }
}

}  // namespace
}  // namespace voxdag
