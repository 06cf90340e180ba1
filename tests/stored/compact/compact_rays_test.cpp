// Tests rays at the compact form: the same hits as at the plain form, to the bit.
#include <gtest/gtest.h>

#include "support/brute_svdag.hpp"
#include "support/caster_checks.hpp"
#include "support/random_bits.hpp"
#include "support/test_rays.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/cpu/packets/in_place_nodes.hpp"
#include "voxdag/cpu/packets/packet_caster.hpp"
#include "voxdag/stored/compact/encode_svdag.hpp"
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/compact_svdag_nodes.hpp"
#include "voxdag/trace/stop_below_size.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {
namespace {

Grid example_grid(int levels) {
  Grid grid;
  grid.levels = levels;
  grid.origin = {-3, 1, 5};
  grid.voxel_size = 0.25;
  grid.quantization_scale = 1024;
  return grid;
}

/// Expects equal results of random rays of every kind, with and without level of detail.
void expect_equal_hits(const Svdag& dag, int rays_per_kind) {
  const CompactSvdag compact = encode_svdag(dag.view());
  LastDecoded cache;
  const CompactSvdagNodes<LastDecoded> nodes(compact.view(), cache);
  const SvdagNodes plain(dag.view());
  const Grid grid = example_grid(dag.levels);
  TestRays rays(grid, 7);
  int hits = 0;
  for (int kind = 0; kind < static_cast<int>(RayKind::kCount); ++kind)
    for (int i = 0; i < rays_per_kind; ++i) {
      const GridRay ray = make_grid_ray(grid, rays.make(static_cast<RayKind>(kind)));
      const auto compare = [&](const auto& stop) {
        CellHit expected, found;
        const bool is_hit = cast(plain, ray, stop, expected);
        ASSERT_EQ(cast(nodes, ray, stop, found), is_hit);
        if (!is_hit) return;
        ++hits;
        EXPECT_EQ(found.t, expected.t);
        EXPECT_EQ(found.x, expected.x);
        EXPECT_EQ(found.y, expected.y);
        EXPECT_EQ(found.z, expected.z);
        EXPECT_EQ(found.level, expected.level);
      };
      compare(StopAtVoxels());
      compare([](int level, float, float) { return level >= 3; });
    }
  if (dag.leaf_blocks.size() > 50) {
    EXPECT_GT(hits, 100);
  }
}

std::vector<Svdag> example_dags() {
  std::vector<Svdag> dags;
  for (int levels = 2; levels <= 9; ++levels)
    for (const int count : {0, 1, 60, 3000})
      dags.push_back(brute_svdag(levels, random_voxels(levels, count, 5)));
  return dags;
}

TEST(CompactRays, HitTheSameVoxelsWithACacheOfTheLastNode) {
  for (const Svdag& dag : example_dags()) expect_equal_hits(dag, 40);
}

TEST(CompactRays, EndAtAnyStream) {
  const Svdag dag = brute_svdag(7, random_voxels(7, 3000, 5));
  CompactSvdag compact = encode_svdag(dag.view());
  Random random(9);
  const Grid grid = example_grid(7);
  for (int round = 0; round < 50; ++round) {
    for (std::size_t i = 0; i + 1 < compact.stream.size(); ++i) compact.stream[i] = random();
    LastDecoded cache;
    const CompactSvdagNodes<LastDecoded> nodes(compact.view(), cache);
    TestRays rays(grid, static_cast<unsigned>(round));
    for (int i = 0; i < 20; ++i) closest_hit(nodes, grid, rays.make(RayKind::kGeneric));
  }
}

/// Expects packets and single rays at the compact form to meet what single rays meet at the plain
/// form. A cache of two units decodes units again and again.
void expect_same_results(int levels, unsigned seed, const std::vector<CastRay>& rays) {
  for (const NamedVoxels& set : voxel_sets(levels, seed)) {
    const Svdag dag = brute_svdag(levels, set.voxels);
    const CompactSvdag compact = encode_svdag(dag.view());
    const SvdagNodes nodes(dag.view());
    const InPlaceDag small(compact.view(), 2), large(compact.view(), 1024);
    expect_same_hits(nodes, PacketCaster<InPlaceDag>(large), rays, set.name);
    const std::vector<CastRay> some(rays.begin(), rays.begin() + static_cast<int>(rays.size() / 8));
    expect_same_hits(nodes, PacketCaster<InPlaceDag>(small), some, set.name + ", two units");
    const ScalarCaster<InPlaceNodes> scalar(InPlaceNodes(small, small.cache()));
    expect_same_hits(nodes, scalar, some, set.name + ", single rays");
  }
}

TEST(CompactPackets, MeetWhatTheScalarCastMeets) {
  for (const int levels : {4, 5, 6})
    expect_same_results(levels, 3, rays_of_every_kind(grid_of(levels), 80, 7));
}

TEST(CompactPackets, EndAtTheSameLevelOfDetail) {
  for (const float coarse : {0x1p-5f, 0x1p-2f}) {
    auto rays = rays_of_every_kind(grid_of(6), 80, 8);
    set_random_stops(rays, coarse, 0x1p-3f, 1);
    expect_same_results(6, 4, rays);
  }
}

TEST(CompactPackets, RaysThatStartOnTheirWayMeetTheSame) {
  auto rays = ray_bundles(grid_of(7), 0.002, 0.01);
  rays.resize(rays.size() / 4);
  expect_same_results(7, 9, rays);
}

TEST(CompactPackets, RaysThatShareTheirVoxelsMeetTheSame) {
  expect_same_results(5, 10, ray_bundles(grid_of(5), 0.0002, 0));
}

TEST(CompactPackets, ShortRaysOfOnePointMeetTheSame) {
  expect_same_results(6, 6, short_rays_of_points(grid_of(6), 30));
}

TEST(CompactPackets, ABrokenStreamIsRefusedOrSafe) {
  const Svdag dag = brute_svdag(7, random_voxels(7, 3000, 5));
  CompactSvdag compact = encode_svdag(dag.view());
  const std::vector<std::uint32_t> stream = compact.stream;
  Random random(3);
  const auto rays = rays_of_every_kind(grid_of(7), 5, 2);
  int refused = 0;
  for (int round = 0; round < 200; ++round) {
    compact.stream = stream;
    const std::uint64_t bit = random() % compact.stream_bits;
    compact.stream[bit / 32] ^= 1u << (bit % 32);
    try {
      const InPlaceDag in_place(compact.view(), 2);
      any_hits(PacketCaster<InPlaceDag>(in_place), rays);
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()), "the stream of the compact DAG is broken");
      ++refused;
    }
  }
  EXPECT_GT(refused, 20);
}

}  // namespace
}  // namespace voxdag
