#include "voxdag/trace/beam.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "support/brute_svdag.hpp"
#include "support/test_esvo.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/esvo_cast.hpp"
#include "voxdag/trace/stop_below_size.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {
namespace {

constexpr int kBeamLevels = 5;

Grid unit_grid() {
  Grid grid;
  grid.levels = kBeamLevels;
  grid.voxel_size = std::ldexp(1.0, -kBeamLevels);
  return grid;
}

class RandomBeams {
 public:
  explicit RandomBeams(unsigned seed) : rng_(seed) {}

  double number(double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(rng_);
  }
  Vec3d point(double lo, double hi) { return {number(lo, hi), number(lo, hi), number(lo, hi)}; }

  /// Returns a random beam: its apex is inside or outside the grid; it is narrow or wide, parallel
  /// to an axis or not.
  Beam beam() {
    Beam beam;
    beam.apex = number(0, 1) < 0.5 ? point(0, 1) : point(-1.5, 2.5);
    Vec3d middle = point(0, 1) - beam.apex;
    if (number(0, 1) < 0.2) middle = {0, number(0, 1) < 0.5 ? 1.0 : -1.0, 0};
    const Vec3d half = point(0, 1) * std::pow(10, number(-4, -0.3));
    beam.lowest = middle - half;
    beam.highest = middle + half;
    return beam;
  }
  /// Returns a direction within the beam, often on its border.
  Vec3d direction(const Beam& beam) {
    Vec3d direction;
    for (int axis = 0; axis < 3; ++axis) {
      const double where = std::clamp(number(-0.5, 1.5), 0.0, 1.0);
      const double d = beam.lowest[axis] + (beam.highest[axis] - beam.lowest[axis]) * where;
      direction[axis] = std::clamp(d, beam.lowest[axis], beam.highest[axis]);
    }
    return direction;
  }

 private:
  std::mt19937 rng_;
};

struct BeamCounts {
  int met = 0, hits = 0;
};

/// Casts beams and rays within them. A ray that the beam shortens must meet the same cell as the
/// whole ray.
template <class Nodes>
void expect_bounds_hold(const Nodes& nodes, const std::string& name, RandomBeams& random,
                        BeamCounts& counts) {
  const Grid grid = unit_grid();
  for (int i = 0; i < 1500; ++i) {
    const Beam beam = random.beam();
    const double size_per_t = random.number(0, 1) < 0.5 ? 0 : random.number(0, 0.2);
    const double width = random.number(0, 1) < 0.3 ? 0 : random.number(0, 0.4);
    const BeamStop stop{0, width, size_per_t * (1 + 1e-6)};
    double first = 0, last = 0;
    const bool is_met = first_met(nodes, beam, stop, first);
    const bool is_met_at_all = last_met(nodes, beam, BeamStop{0, width, 0}, last);
    counts.met += is_met ? 1 : 0;
    for (int j = 0; j < 12; ++j) {
      const Vec3d direction = random.direction(beam);
      const GridRay whole = make_grid_ray(grid, beam.apex, direction, 0, HUGE_VAL);
      const StopBelowSize ray_stop = stop_below_size(grid, whole, size_per_t);
      CellHit expected, found;
      const bool is_hit = cast(nodes, whole, ray_stop, expected);
      counts.hits += is_hit ? 1 : 0;
      if (!is_met) {
        EXPECT_FALSE(is_hit) << name;
        continue;
      }
      const GridRay shortened = make_grid_ray(grid, beam.apex, direction, first, HUGE_VAL);
      ASSERT_EQ(cast(nodes, shortened, ray_stop, found), is_hit) << name;
      EXPECT_EQ(found.t, expected.t) << name;
      EXPECT_EQ(found.x, expected.x);
      EXPECT_EQ(found.level, expected.level);
      const double after = is_met_at_all ? last * (1 + 1e-6) : 0;
      const GridRay beyond = make_grid_ray(grid, beam.apex, direction, after, HUGE_VAL);
      EXPECT_FALSE(cast(nodes, beyond, StopAtVoxels{}, found)) << name;
    }
  }
}

TEST(Beam, ItsBoundsShortenNoRayThatMeetsAnything) {
  RandomBeams random(5);
  BeamCounts counts;
  for (const NamedVoxels& set : voxel_sets(kBeamLevels, 3)) {
    const Svdag dag = brute_svdag(kBeamLevels, set.voxels);
    expect_bounds_hold(SvdagNodes(dag.view()), set.name, random, counts);
  }
  EXPECT_GT(counts.met, 5000);
  EXPECT_GT(counts.hits, 30000);
}

TEST(Beam, ItsBoundsHoldForShapesAndCoarseLeaves) {
  RandomBeams random(6);
  BeamCounts counts;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    std::mt19937 rng(seed);
    const Esvo esvo =
        TestEsvoAssembler(3, seed).assemble(*random_octree(rng, 0, kBeamLevels), kBeamLevels);
    expect_bounds_hold(ContourNodes(esvo.view()), "contours", random, counts);
  }
  EXPECT_GT(counts.met, 2000);
  EXPECT_GT(counts.hits, 5000);
}

TEST(Beam, ABeamOfOneRayEndsWhereTheRayDoes) {
  const Grid grid = unit_grid();
  RandomBeams random(7);
  for (const NamedVoxels& set : voxel_sets(kBeamLevels, 3)) {
    const Svdag dag = brute_svdag(kBeamLevels, set.voxels);
    const SvdagNodes nodes(dag.view());
    for (int i = 0; i < 300; ++i) {
      Beam beam = random.beam();
      beam.lowest = beam.highest = random.direction(beam);
      const GridRay ray = make_grid_ray(grid, beam.apex, beam.lowest, 0, HUGE_VAL);
      CellHit cell;
      double bound = 0;
      if (!cast(nodes, ray, StopAtVoxels{}, cell)) continue;
      ASSERT_TRUE(first_met(nodes, beam, {}, bound));
      const double hit = ray.to_world_t(static_cast<double>(cell.t));
      EXPECT_LE(bound, hit * (1 + 1e-6));
      // The beam may end at a cell that the ray barely misses. Then this cell is near the line.
      const Vec3d at = beam.apex + beam.lowest * bound;
      const auto gap = [&](Vec3i v) {
        double most = 0;
        for (int axis = 0; axis < 3; ++axis) {
          const double lo = v[axis] * grid.voxel_size, hi = lo + grid.voxel_size;
          most = std::max({most, lo - at[axis], at[axis] - hi});
        }
        return most;
      };
      double nearest = 1;
      for (const Vec3i v : set.voxels) nearest = std::min(nearest, gap(v));
      EXPECT_LE(nearest, 2 * kBeamSlack) << set.name;
    }
  }
}

TEST(Beam, KeepsToItsRange) {
  const Svdag dag = brute_svdag(kBeamLevels, {{16, 16, 16}});
  const SvdagNodes nodes(dag.view());
  Beam beam;
  beam.apex = {0.51, 0.51, -1};
  beam.lowest = {-0.001, -0.001, 1};
  beam.highest = {0.001, 0.001, 1};
  double bound = 0;
  ASSERT_TRUE(first_met(nodes, beam, {}, bound));
  EXPECT_NEAR(bound, 1.5, 1e-6);
  ASSERT_TRUE(last_met(nodes, beam, {}, bound));
  EXPECT_NEAR(bound, 1.5 + 1.0 / 32, 1e-6);
  beam.t_max = 1.49;
  EXPECT_FALSE(first_met(nodes, beam, {}, bound));
  beam.t_min = 1.54;
  beam.t_max = HUGE_VAL;
  EXPECT_FALSE(last_met(nodes, beam, {}, bound));
}

}  // namespace
}  // namespace voxdag
