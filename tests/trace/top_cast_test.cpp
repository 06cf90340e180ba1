// Compares casts at a DAG with a dense grid above it with the paper's layout: both must find the
// same cell for every ray.
#include "voxdag/trace/top_cast.hpp"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <barrier>
#include <thread>

#include "support/brute_svdag.hpp"
#include "support/same_cells.hpp"
#include "voxdag/trace/refill_caster.hpp"

namespace voxdag {
namespace {

/// Makes the grids of DAGs and owns the last one.
struct MakeTop {
  int levels_below = 2;  ///< Levels below the grid's; at least 2.
  TopGrid grid{};
  TopNodes operator()(const SvdagView& dag) {
    grid = make_top_grid(dag, std::max(dag.levels - levels_below, 0));
    return TopNodes(dag, grid.view());
  }
};

TEST(TopCast, MeetsWhatTheOctreeCastMeets) {
  for (const int levels : {2, 3, 4, 5, 6, 7})
    for (const int below : {2, 3}) expect_same_cells(levels, 11, MakeTop{below}, no_size);
}

TEST(TopCast, EndsAtTheSameLevelOfDetail) {
  for (const int levels : {3, 5, 6}) expect_same_cells(levels, 12, MakeTop{}, some_size);
}

/// Rays of every kind, every second one with a level of detail.
std::vector<CastRay> casts_of(const Grid& grid, unsigned seed) {
  TestRays test_rays(grid, seed);
  std::vector<CastRay> rays;
  for (int i = 0; i < 500; ++i)
    for (int kind = 0; kind < static_cast<int>(RayKind::kCount); ++kind)
      rays.push_back({make_grid_ray(grid, test_rays.make(static_cast<RayKind>(kind))),
                      i % 2 == 0 ? no_size(i) : some_size(i)});
  return rays;
}

/// Casts rays[lane], rays[lane + lanes] and so on, and sets their results.
template <class Caster>
void cast_lane(const Caster& caster, const std::vector<CastRay>& rays, std::size_t lane,
               std::size_t lanes, std::vector<int>& results) {
  const auto at = [&](int i) { return lane + static_cast<std::size_t>(i) * lanes; };
  caster.any(
      static_cast<int>((rays.size() - lane + lanes - 1) / lanes),
      [&](int i) -> const CastRay& { return rays[at(i)]; },
      [&](int i, bool is_hit) { results[at(i)] = is_hit ? 1 : 0; });
}

void expect_results(const SvdagView& dag, const std::vector<CastRay>& rays,
                    const std::vector<int>& results) {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    CellHit cell;
    ASSERT_EQ(results[i], cast(SvdagNodes(dag), rays[i].ray, rays[i].stop, cell) ? 1 : 0)
        << "ray " << i;
  }
}

TEST(RefillCaster, FindsWhatSingleRaysFind) {
  Grid grid;
  grid.levels = 5;
  for (const NamedVoxels& set : voxel_sets(grid.levels, 13)) {
    SCOPED_TRACE(set.name);
    const Svdag dag = brute_svdag(grid.levels, set.voxels);
    MakeTop make;
    const std::vector<CastRay> rays = casts_of(grid, 13);
    std::vector<int> results(rays.size(), -1);
    cast_lane(RefillCaster<>(make(dag.view())), rays, 0, 1, results);
    expect_results(dag.view(), rays, results);
  }
}

/// Threads that stand for the lanes of a warp.
struct TestWarp {
  static constexpr std::size_t kLanes = 2 * RefillCaster<>::kStartTogether;
  std::barrier<> barrier{kLanes};
  std::array<std::atomic<int>, 3> counts{};  // of this round, the next one and the last one
};

/// The lanes of the TestWarp of this thread.
class TestLanes {
 public:
  static inline thread_local TestWarp* warp = nullptr;
  int count(bool is) const {
    const std::size_t round = round_++;
    warp->counts[(round + 1) % 3] = 0;
    warp->counts[round % 3] += is ? 1 : 0;
    warp->barrier.arrive_and_wait();
    return warp->counts[round % 3];
  }

 private:
  mutable std::size_t round_ = 0;
};

TEST(RefillCaster, LanesOfAWarpStartTheirRaysTogether) {
  Grid grid;
  grid.levels = 5;
  const Svdag dag = brute_svdag(grid.levels, voxel_sets(grid.levels, 14).back().voxels);
  MakeTop make;
  const RefillCaster<TestLanes> caster(make(dag.view()));
  const std::vector<CastRay> rays = casts_of(grid, 14);
  std::vector<int> results(rays.size(), -1);
  TestWarp warp;
  std::vector<std::thread> lanes;
  for (std::size_t lane = 0; lane < TestWarp::kLanes; ++lane)
    lanes.emplace_back([&, lane] {
      TestLanes::warp = &warp;
      cast_lane(caster, rays, lane, TestWarp::kLanes, results);
    });
  for (std::thread& lane : lanes) lane.join();
  expect_results(dag.view(), rays, results);
}

/// Returns the free way of a cell by definition.
int brute_free_way(const std::vector<bool>& is_set, int side, Vec3i cell, int octant) {
  for (int size = 1; size <= side; ++size)
    for (int i = 0; i < size * size * size; ++i) {
      const Vec3i step{i % size, i / size % size, i / size / size};
      Vec3i at = cell;
      bool is_inside = true;
      for (int axis = 0; axis < 3; ++axis) {
        at[axis] += (octant >> axis & 1) != 0 ? step[axis] : -step[axis];
        is_inside = is_inside && at[axis] >= 0 && at[axis] < side;
      }
      if (is_inside && is_set[static_cast<std::size_t>(at.x + side * (at.y + side * at.z))])
        return size - 1;
    }
  return 255;
}

TEST(TopGrid, HoldsTheNodesAndTheLargestEmptyCubes) {
  constexpr int kLevel = 3, kSide = 1 << kLevel;
  const std::vector<Vec3i> voxels{{0, 0, 0}, {21, 6, 9}, {22, 6, 8}, {31, 31, 31}, {30, 4, 12}};
  const Svdag dag = brute_svdag(5, voxels);
  const TopGrid grid = make_top_grid(dag.view(), kLevel);
  std::vector<bool> is_set(kSide * kSide * kSide);
  for (const Vec3i& v : voxels)
    is_set[static_cast<std::size_t>(v.x / 4 + kSide * (v.y / 4 + kSide * (v.z / 4)))] = true;
  for (std::size_t i = 0; i < is_set.size(); ++i) {
    const std::uint64_t cell = grid.cells[i];
    ASSERT_EQ(TopGridView::is_empty(cell), !is_set[i]);
    const auto n = static_cast<int>(i);
    const Vec3i at{n % kSide, n / kSide % kSide, n / kSide / kSide};
    if (!is_set[i]) {
      for (int octant = 0; octant < 8; ++octant) {
        // A cube that reaches the end of the grid in all directions is free for ever.
        const int expected = brute_free_way(is_set, kSide, at, octant);
        ASSERT_EQ(TopGridView::free_way(cell, static_cast<std::uint32_t>(octant)), expected)
            << at.x << " " << at.y << " " << at.z << " octant " << octant;
      }
      continue;
    }
    std::uint64_t block = 0;
    for (const Vec3i& v : voxels)
      if (v.x / 4 == at.x && v.y / 4 == at.y && v.z / 4 == at.z)
        block |= std::uint64_t{1} << (leaf_bits(v.x % 4, 0) | leaf_bits(v.y % 4, 1) |
                                      leaf_bits(v.z % 4, 2));
    EXPECT_EQ(dag.leaf_blocks[TopGridView::node(cell)], block);
  }
}

}  // namespace
}  // namespace voxdag
