// Compares packets at an ESVO with the scalar cast, ray by ray.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>

#include "support/caster_checks.hpp"
#include "support/test_esvo.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/cpu/packets/packet_caster.hpp"
#include "voxdag/cpu/stream/streamed_nodes.hpp"

namespace voxdag {
namespace {

/// Returns the number of rays that enter their shape through a contour.
template <class Nodes>
int expect_same_results(const Nodes& nodes, const std::vector<CastRay>& rays,
                        const std::string& what) {
  const auto expected = expect_same_hits(nodes, PacketCaster<Nodes>(nodes), rays, what);
  int through_contours = 0;
  for (std::size_t i = 0; i < rays.size(); ++i)
    through_contours += expected.is_hit[i] != 0 && expected.hits[i].is_through_contour() ? 1 : 0;
  return through_contours;
}

Esvo random_esvo(unsigned seed, int levels) {
  std::mt19937 rng(seed);
  const auto root = random_octree(rng, 0, levels);
  return TestEsvoAssembler(1 + seed % 5, seed).assemble(*root, levels);
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
    set_random_stops(rays, 0x1p-4f, 0x1p-2f, seed);
    expect_same_results(ContourNodes(esvo.view()), rays, "contours");
    expect_same_results(EsvoNodes(esvo.view()), rays, "cubes");
  }
}

// Narrow bundles are tested as one wide ray at coarse voxels.
TEST(EsvoPacketCaster, CoherentRaysMeetTheSame) {
  int through_contours = 0;
  for (const double width : {0.0005, 0.01, 0.1})
    for (unsigned seed = 1; seed <= 4; ++seed) {
      const int levels = 4 + static_cast<int>(seed % 2);
      const Esvo esvo = random_esvo(20 + seed, levels);
      const auto rays = ray_bundles(grid_of(levels), width, seed % 2 == 0 ? 0.05 : 0.0);
      through_contours += expect_same_results(ContourNodes(esvo.view()), rays, "contours");
      expect_same_results(EsvoNodes(esvo.view()), rays, "cubes");
    }
  EXPECT_GT(through_contours, 5000);
}

TEST(EsvoPacketCaster, ShortRaysOfOnePointMeetTheSame) {
  const auto rays = short_rays_of_points(grid_of(5), 100);
  for (unsigned of = 1; of <= 4; ++of) {
    const Esvo esvo = random_esvo(of, 5);
    expect_same_results(ContourNodes(esvo.view()), rays, "contours");
  }
}

// The slack of a contour's planes depends on where the ray leaves the cube, even if the ray's range
// ends long before.
TEST(EsvoPacketCaster, ShortRaysBesideAContourMeetTheSame) {
  TestVoxel root;
  root.children[0] = std::make_unique<TestVoxel>();
  root.children[0]->contour = Contour::make({31, 0, 0}, 0, 63);
  const Esvo esvo = TestEsvoAssembler(1, 1).assemble(root, 2);
  const int plane = ContourSlab::make(*root.children[0]->contour, 0, 22).high / 31;
  std::vector<CastRay> rays;
  for (int above = 0; above < 8; ++above)
    for (int i = 0; i < 64; ++i) {
      const float x = 1.25f + static_cast<float>(plane + above) * 0x1p-23f;
      const Vec3f direction{0.001f * static_cast<float>(i), 1, 0.01f * static_cast<float>(i % 8)};
      rays.push_back({make_grid_ray(GridPoint{{x, 1.1f, 1.1f}}, direction, 0, 1e-4f), {}});
    }
  const ContourNodes nodes(esvo.view());
  const auto expected = expect_same_hits(nodes, PacketCaster<ContourNodes>(nodes), rays, "short");
  const auto hits = std::count(expected.is_hit.begin(), expected.is_hit.end(), 1);
  EXPECT_GT(hits, 64);
  EXPECT_LT(hits, 8 * 64);
}

TEST(EsvoPacketCaster, RaysThatStartAlongOneAxisMeetTheSame) {
  for (int axis = 0; axis < 3; ++axis)
    for (unsigned seed = 1; seed <= 6; ++seed) {
      const int levels = 4;
      const Esvo esvo = random_esvo(seed, levels);
      std::vector<CastRay> rays;
      for (int i = 0; i < 256; ++i) {
        GridPoint start{{1.3f, 1.4f, 1.6f}};
        start.position[axis] = 1 + static_cast<float>(i) * 0x1p-8f;
        rays.push_back({make_grid_ray(start, {0.3f, -0.8f, 0.5f}, 0, HUGE_VALF), {}});
      }
      expect_same_results(ContourNodes(esvo.view()), rays, "along axis " + std::to_string(axis));
    }
}

// Each axis has rays that are parallel to it, so the range of the rays' directions bounds nothing.
TEST(EsvoPacketCaster, RaysAlongAllAxesFromOnePointMeetTheSame) {
  for (int levels = 2; levels <= 18; ++levels) {
    const int middle = 1 << (levels - 1);
    const auto root = test_octree(levels, {{middle, middle, middle}});
    first_leaf(*root).contour = Contour::make({31, 31, 31}, 0, 127);
    const Esvo esvo = TestEsvoAssembler(1, 1).assemble(*root, levels);
    const float start = 1.5f + std::ldexp(0.3f, -levels);
    std::vector<CastRay> rays;
    for (int i = 0; i < 64; ++i) {
      Vec3f direction{};
      direction[i % 3] = 1;
      rays.push_back(
          {make_grid_ray(GridPoint{{start, start, start}}, direction, 0, HUGE_VALF), {}});
    }
    expect_same_results(ContourNodes(esvo.view()), rays, std::to_string(levels) + " levels");
  }
}

/// Counts how often rays end at the leaves of each descriptor.
class CountedLeaves : public LeafListener {
 public:
  void on_leaf(std::uint64_t slot) const override { ++counts_[slot]; }
  std::map<std::uint64_t, int> take() const { return std::exchange(counts_, {}); }

 private:
  mutable std::map<std::uint64_t, int> counts_;
};

TEST(EsvoPacketCaster, ReportsTheSameLeavesWhereBlocksMayBeMissing) {
  const int levels = 5;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const Esvo esvo = random_esvo(seed, levels);
    auto rays = rays_of_every_kind(grid_of(levels), 300, seed);
    set_random_stops(rays, 0x1p-4f, 0x1p-3f, seed);
    const CountedLeaves leaves;
    const StreamedNodes nodes(esvo.view(), leaves);
    const auto hits = closest_hits<EsvoHit>(ScalarCaster<StreamedNodes>(nodes), rays);
    const auto expected = leaves.take();
    std::ptrdiff_t told = 0;
    for (const auto& [slot, count] : expected) told += count;
    EXPECT_GT(told, 30);
    EXPECT_LT(told, std::count(hits.is_hit.begin(), hits.is_hit.end(), 1)) << "none is too small";
    closest_hits<EsvoHit>(PacketCaster<StreamedNodes>(nodes), rays);
    EXPECT_EQ(leaves.take(), expected) << "closest, seed " << seed;
    any_hits(PacketCaster<StreamedNodes>(nodes), rays);
    EXPECT_EQ(leaves.take(), expected) << "any, seed " << seed;
  }
}

}  // namespace
}  // namespace voxdag
