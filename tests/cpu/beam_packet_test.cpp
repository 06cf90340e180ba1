// Compares beams in packets with beams that are cast one at a time.
#include "voxdag/cpu/packets/beam_packet.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <random>

#include "support/brute_svdag.hpp"
#include "support/test_esvo.hpp"
#include "support/voxel_sets.hpp"

namespace voxdag {
namespace {

/// Returns beams like those of 8×8 pixels each, side by side from one point, in any direction.
BeamPacket random_packet(std::mt19937& rng, std::size_t size) {
  std::uniform_real_distribution<double> unit(-1, 1);
  BeamPacket packet;
  packet.apex = {0.5 + unit(rng), 0.5 + unit(rng), 0.5 + unit(rng)};
  const Vec3d target{0.5 + unit(rng) / 2, 0.5 + unit(rng) / 2, 0.5 + unit(rng) / 2};
  const Vec3d middle = target - packet.apex;
  const double width = 0.03 * std::fabs(unit(rng));
  for (std::size_t i = 0; i < size; ++i) {
    const Vec3d low = middle + Vec3d{static_cast<double>(i % 8) * width,
                                     static_cast<double>(i / 8) * width, unit(rng) * width};
    packet.add(low, low + Vec3d{width, width, 0});
  }
  if (rng() % 2 == 0) packet.stop = {0.02 * (unit(rng) + 1), 0.05, 0.02 * (unit(rng) + 1)};
  return packet;
}

/// Returns the t at which beam i alone meets anything.
template <class Nodes>
double expected_first(const Nodes& nodes, const BeamPacket& packet, std::size_t i) {
  Beam beam;
  beam.apex = packet.apex;
  for (int axis = 0; axis < 3; ++axis) {
    beam.lowest[axis] = packet.lowest[axis][i];
    beam.highest[axis] = packet.highest[axis][i];
  }
  double first = 0;
  return first_met(nodes, beam, packet.stop, first) ? first : HUGE_VAL;
}

/// Returns the number of beams that meet something.
template <class Nodes>
int expect_same_starts(const Nodes& nodes, unsigned seed) {
  constexpr double kRounding = 0x1p-18;
  int met = 0;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    std::mt19937 rng(seed);
    for (const std::size_t size : {1, 1, 1, 1, 3, 9, 64, 64, 64}) {
      BeamPacket packet = random_packet(rng, size);
      cast_beam_packet(nodes, packet);
      for (std::size_t i = 0; i < size; ++i) {
        const double expected = expected_first(nodes, packet, i);
        const auto first = static_cast<double>(packet.first[i]);
        EXPECT_LE(first, expected) << hwy::TargetName(target);
        // In a packet whose beams run in different directions along an axis, some beams count as
        // wider.
        if (size == 1 && expected < HUGE_VAL) {
          EXPECT_GE(first, expected * (1 - kRounding));
        } else if (size == 1) {
          EXPECT_EQ(first, HUGE_VAL);
        }
        met += first < HUGE_VAL ? 1 : 0;
      }
    }
  }
  hwy::SetSupportedTargetsForTest(0);
  return met;
}

TEST(BeamPacket, StartsNoLaterThanItsBeamsAlone) {
  int met = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    std::mt19937 rng(seed);
    const int levels = 3 + static_cast<int>(seed % 4);
    const Esvo esvo = TestEsvoAssembler(2, seed).assemble(*random_octree(rng, 0, levels), levels);
    met += expect_same_starts(EsvoNodes(esvo.view()), seed);
  }
  EXPECT_GT(met, 1000);
}

TEST(BeamPacket, TakesDags) {
  for (const NamedVoxels& set : voxel_sets(5, 3)) {
    const Svdag dag = brute_svdag(5, set.voxels);
    for (unsigned seed = 1; seed <= 5; ++seed) expect_same_starts(SvdagNodes(dag.view()), seed);
  }
}

}  // namespace
}  // namespace voxdag
