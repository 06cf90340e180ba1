// Packets at an ESVO against the scalar cast, ray by ray.
#include "voxdag/cpu/esvo_packet_caster.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <vector>

#include "support/test_esvo.hpp"
#include "support/test_rays.hpp"
#include "support/voxel_sets.hpp"

namespace voxdag {
namespace {

struct Result {
  EsvoHit hit;
  bool is_hit = false;
};

bool same(const Result& a, const Result& b) {
  if (a.is_hit != b.is_hit) return false;
  const EsvoHit &p = a.hit, &q = b.hit;
  return !a.is_hit || (p.t == q.t && p.x == q.x && p.y == q.y && p.z == q.z && p.level == q.level &&
                       p.voxel.slot == q.voxel.slot && p.voxel.child == q.voxel.child &&
                       p.plane.contour == q.plane.contour &&
                       (!p.is_through_contour() || p.plane.level == q.plane.level));
}

template <class Caster>
std::vector<Result> closest(const Caster& caster, const std::vector<CastRay>& rays) {
  std::vector<Result> results(rays.size());
  caster.closest(
      static_cast<int>(rays.size()), [&](int i) { return rays[static_cast<std::size_t>(i)]; },
      [&](int i, const GridRay&, const EsvoHit& hit, bool is_hit) {
        results[static_cast<std::size_t>(i)] = {hit, is_hit};
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

/// Returns how many rays enter their shape through a contour.
template <class Nodes>
int expect_same_results(const Nodes& nodes, const std::vector<CastRay>& rays,
                        const std::string& what) {
  const auto expected = closest(ScalarCaster<Nodes>(nodes), rays);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(static_cast<std::uint32_t>(target));
    const auto found = closest(EsvoPacketCaster<Nodes>(nodes), rays);
    const auto met = any(EsvoPacketCaster<Nodes>(nodes), rays);
    int wrong = 0;
    for (std::size_t i = 0; i < rays.size(); ++i)
      wrong += !same(found[i], expected[i]) || (met[i] != 0) != expected[i].is_hit ? 1 : 0;
    EXPECT_EQ(wrong, 0) << "of " << rays.size() << " rays, " << what << ", "
                        << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
  int through_contours = 0;
  for (const Result& result : expected)
    through_contours += result.is_hit && result.hit.is_through_contour() ? 1 : 0;
  return through_contours;
}

Esvo random_esvo(unsigned seed, int levels) {
  std::mt19937 rng(seed);
  const auto root = random_octree(rng, 0, levels);
  return TestEsvoAssembler(1 + seed % 5, seed).assemble(*root, levels);
}

Grid grid_of(int levels) {
  Grid grid;
  grid.levels = levels;
  return grid;
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

/// Bundles like those of 8×8 pixels, each from a point of its own after some way.
std::vector<CastRay> bundles(const Grid& grid, double width, double size_per_t) {
  const double n = static_cast<double>(grid.resolution());
  std::vector<CastRay> rays;
  for (int bundle = 0; bundle < 300; ++bundle) {
    const double a = bundle * 0.7, b = bundle * 0.31;
    const Vec3d eye =
        Vec3d{0.5 + 0.4 * std::sin(a), 0.5 + 0.3 * std::cos(b), 0.5 + 0.2 * std::sin(a + b)} * n;
    for (int i = 0; i < 64; ++i) {
      const Vec3d direction{std::cos(a) + width * (i % 8), std::sin(b) + width * (i / 8), 0.3};
      CastRay ray;
      ray.ray = make_grid_ray(grid, eye, direction, bundle % 5 * 0.1 * n, HUGE_VAL);
      ray.stop = stop_below_size(grid, ray.ray, size_per_t * (bundle % 4));
      rays.push_back(ray);
    }
  }
  return rays;
}

TEST(EsvoPacketCaster, MeetsTheShapesThatTheScalarCastMeets) {
  int through_contours = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const int levels = 2 + static_cast<int>(seed % 4);
    const Esvo esvo = random_esvo(seed, levels);
    const auto rays = rays_of_every_kind(grid_of(levels), 300, seed);
    through_contours += expect_same_results(ContourNodes(esvo.view()), rays, "contours");
    expect_same_results(EsvoNodes(esvo.view()), rays, "cubes");
  }
  EXPECT_GT(through_contours, 500);
}

TEST(EsvoPacketCaster, MeetsTheSameVoxelsOfEverySet) {
  const int levels = 5;
  const auto rays = rays_of_every_kind(grid_of(levels), 200, 7);
  for (const NamedVoxels& set : voxel_sets(levels, 3)) {
    if (set.voxels.empty()) continue;
    const Esvo esvo = TestEsvoAssembler(3, 1).assemble(*test_octree(levels, set.voxels), levels);
    expect_same_results(EsvoNodes(esvo.view()), rays, set.name);
  }
}

TEST(EsvoPacketCaster, AnEsvoWithoutVoxelsIsMissed) {
  const auto rays = rays_of_every_kind(grid_of(3), 5, 7);
  EXPECT_EQ(expect_same_results(ContourNodes(EsvoView{}), rays, "empty"), 0);
}

TEST(EsvoPacketCaster, EndsAtTheSameLevelOfDetail) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const int levels = 4 + static_cast<int>(seed % 2);
    const Esvo esvo = random_esvo(seed, levels);
    auto rays = rays_of_every_kind(grid_of(levels), 300, seed);
    unsigned random = seed;
    for (CastRay& ray : rays) {
      random = random * 1664525u + 1013904223u;
      ray.stop.at_start = static_cast<float>(random >> 16 & 0xFFu) * 0x1p-12f;
      ray.stop.per_t = static_cast<float>(random >> 24) * 0x1p-10f;
    }
    expect_same_results(ContourNodes(esvo.view()), rays, "contours");
    expect_same_results(EsvoNodes(esvo.view()), rays, "cubes");
  }
}

// As cameras cast them, shortened by beams: narrow ones are taken for one wide ray at coarse
// voxels.
TEST(EsvoPacketCaster, BundlesMeetTheSame) {
  int through_contours = 0;
  for (const double width : {0.0005, 0.01, 0.1})
    for (unsigned seed = 1; seed <= 4; ++seed) {
      const int levels = 4 + static_cast<int>(seed % 2);
      const Esvo esvo = random_esvo(20 + seed, levels);
      const auto rays = bundles(grid_of(levels), width, seed % 2 == 0 ? 0.05 : 0.0);
      through_contours += expect_same_results(ContourNodes(esvo.view()), rays, "contours");
      expect_same_results(EsvoNodes(esvo.view()), rays, "cubes");
    }
  EXPECT_GT(through_contours, 5000);
}

// As occlusion casts them: many short rays from one point, packed into the same packets.
TEST(EsvoPacketCaster, ShortRaysOfOnePointMeetTheSame) {
  std::vector<CastRay> rays;
  unsigned seed = 5;
  const auto number = [&] {
    seed = seed * 1664525u + 1013904223u;
    return static_cast<float>(seed >> 8) * 0x1p-24f;
  };
  for (int point = 0; point < 100; ++point) {
    const GridPoint start{{1 + number(), 1 + number(), 1 + number()}};
    for (int i = 0; i < 64; ++i) {
      const Vec3f direction{number() - 0.5f, number() - 0.5f, number() - 0.5f};
      rays.push_back({make_grid_ray(start, direction, i % 5 == 0 ? 0.1f * number() : 0.0f,
                                    0.2f * number() + 0.1f),
                      {}});
    }
  }
  for (unsigned of = 1; of <= 4; ++of) {
    const Esvo esvo = random_esvo(of, 5);
    expect_same_results(ContourNodes(esvo.view()), rays, "contours");
  }
}

}  // namespace
}  // namespace voxdag
