// Compares packets at a DAG with the scalar cast, ray by ray.
#include "voxdag/cpu/packets/packet_caster.hpp"

#include <gtest/gtest.h>

#include "support/brute_svdag.hpp"
#include "support/caster_checks.hpp"
#include "support/voxel_sets.hpp"

namespace voxdag {
namespace {

void expect_same_results(int levels, unsigned seed, const std::vector<CastRay>& rays) {
  for (const NamedVoxels& set : voxel_sets(levels, seed)) {
    const Svdag dag = brute_svdag(levels, set.voxels);
    const SvdagNodes nodes(dag.view());
    expect_same_hits(nodes, PacketCaster<BoundedDag>(BoundedDag(nodes)), rays, set.name);
  }
}

TEST(PacketCaster, MeetsWhatTheScalarCastMeets) {
  for (const int levels : {2, 3, 5, 6})
    expect_same_results(levels, 3, rays_of_every_kind(grid_of(levels), 300, 7));
}

TEST(PacketCaster, EndsAtTheSameLevelOfDetail) {
  auto rays = rays_of_every_kind(grid_of(6), 300, 8);
  set_random_stops(rays, 0x1p-5f, 0x1p-3f, 1);
  expect_same_results(6, 4, rays);
}

TEST(PacketCaster, RaysThatStartOnTheirWayEndAtTheSameLevelOfDetail) {
  expect_same_results(7, 9, ray_bundles(grid_of(7), 0.002, 0.01));
}

TEST(PacketCaster, RaysThatShareTheirVoxelsMeetTheSame) {
  for (const double width : {0.003, 0.0002})
    expect_same_results(5, 10, ray_bundles(grid_of(5), width, 0));
}

TEST(PacketCaster, ShortRaysOfOnePointMeetTheSame) {
  expect_same_results(7, 6, short_rays_of_points(grid_of(7), 100));
}

}  // namespace
}  // namespace voxdag
