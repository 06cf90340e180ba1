#include "voxdag/algebra/carve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "support/error_of.hpp"
#include "voxdag/algebra/query/voxel_moments.hpp"
#include "voxel_grid.hpp"

namespace voxdag {
namespace {

/// Returns whether is_wanted(p) holds for a place p with |p - v| <= half.
template <class IsWanted>
bool any_within(Vec3i v, Vec3i half, const IsWanted& is_wanted) {
  for (int z = -half.z; z <= half.z; ++z)
    for (int y = -half.y; y <= half.y; ++y)
      for (int x = -half.x; x <= half.x; ++x)
        if (is_wanted(v + Vec3i{x, y, z})) return true;
  return false;
}

/// The space that a box of places can reach, place by place.
class BruteSpace {
 public:
  BruteSpace(int levels, const std::vector<Vec3i>& voxels, Vec3i half)
      : levels_(levels), half_(half), grid_(levels, voxels) {
    box_ = {voxels.front(), voxels.front() + Vec3i{1, 1, 1}};
    for (const Vec3i v : voxels) {
      box_.lo = min(box_.lo, v);
      box_.hi = max(box_.hi, v + Vec3i{1, 1, 1});
    }
  }
  bool is_in_box(Vec3i v) const {
    for (int axis = 0; axis < 3; ++axis)
      if (v[axis] < box_.lo[axis] || v[axis] >= box_.hi[axis]) return false;
    return true;
  }
  bool can_be_at(Vec3i v) const {
    return is_in_box(v) && !any_within(v, half_, [&](Vec3i p) { return grid_.contains(p); });
  }
  /// Returns the space that is reached from a place where the body can be.
  VoxelGrid reached(Vec3i seed) const {
    std::vector<Vec3i> stack{seed}, found{seed};
    std::vector<bool> seen(std::size_t{1} << (3 * levels_));
    const auto place = [&](Vec3i v) {
      return static_cast<std::size_t>(((v.z << levels_ | v.y) << levels_) | v.x);
    };
    seen[place(seed)] = true;
    while (!stack.empty()) {
      const Vec3i v = stack.back();
      stack.pop_back();
      for (int step = 0; step < 6; ++step) {
        Vec3i next = v;
        next[step / 2] += step % 2 == 0 ? 1 : -1;
        if (!can_be_at(next) || seen[place(next)]) continue;
        seen[place(next)] = true;
        stack.push_back(next);
        found.push_back(next);
      }
    }
    const VoxelGrid centers(levels_, found);
    return VoxelGrid(levels_, voxels_where(levels_, [&](Vec3i v) {
                       return is_in_box(v) &&
                              any_within(v, half_, [&](Vec3i p) { return centers.contains(p); });
                     }));
  }
  const Box3i& box() const { return box_; }

 private:
  int levels_;
  Vec3i half_;
  VoxelGrid grid_;
  Box3i box_;
};

void expect_brute_carving(int levels, const std::vector<Vec3i>& voxels, Vec3i seed, Vec3i half) {
  const Svdag dag = brute_svdag(levels, voxels);
  const BruteSpace brute(levels, voxels, half);
  ASSERT_EQ(moments_of(dag.view(), {}).bounds, brute.box());
  if (!brute.can_be_at(seed)) {
    EXPECT_NE(error_of([&] {
                carve(dag.view(), seed, half, CarveForm::kWall);
              }).find("cannot be at its first place"),
              std::string::npos);
    return;
  }
  const VoxelGrid space = brute.reached(seed);
  const Vec3i one{1, 1, 1};
  EXPECT_EQ(
      carve(dag.view(), seed, half, CarveForm::kWall), VoxelGrid::dag_of(levels, [&](Vec3i v) {
        return !space.contains(v) && any_within(v, one, [&](Vec3i p) { return space.contains(p); });
      }));
  Box3i used{{99, 99, 99}, {-1, -1, -1}};
  for (const Vec3i v : voxels_where(levels, [&](Vec3i p) { return space.contains(p); })) {
    used.lo = min(used.lo, v);
    used.hi = max(used.hi, v);
  }
  EXPECT_EQ(carve(dag.view(), seed, half, CarveForm::kSolid),
            VoxelGrid::dag_of(levels, [&](Vec3i v) {
              for (int axis = 0; axis < 3; ++axis)
                if (v[axis] < used.lo[axis] - 1 || v[axis] > used.hi[axis] + 1) return false;
              return !space.contains(v);
            }));
}

TEST(Carve, TheSpaceIsWhatABoxReachesStepByStep) {
  std::mt19937 rng(5);
  int carved = 0;
  for (const int levels : {2, 3, 4})
    for (const NamedVoxels& set : voxel_sets(levels, 31)) {
      if (set.voxels.empty()) continue;
      for (const Vec3i half : {Vec3i{0, 0, 0}, Vec3i{1, 0, 1}, Vec3i{0, 2, 1}})
        for (int i = 0; i < 3; ++i) {
          const auto any = [&] { return static_cast<std::int32_t>(rng() % (1u << levels)); };
          const Vec3i seed{any(), any(), any()};
          SCOPED_TRACE(set.name);
          expect_brute_carving(levels, set.voxels, seed, half);
          ++carved;
        }
    }
  EXPECT_GT(carved, 100);
}

TEST(Carve, ACapsuleStaysInItsRoom) {
  // Two rooms with a door of 3 x 5 places between them, and a cellar.
  const auto is_wall = [](Vec3i v) {
    const bool is_side =
        v.x % 15 == 0 || v.y == 2 || v.y == 14 || v.y == 0 || v.z % 15 == 0 || v.z == 29;
    const bool is_door = v.x == 15 && v.y > 2 && v.y < 8 && v.z > 5 && v.z < 9;
    return is_side && !is_door && v.y <= 14;
  };
  const std::vector<Vec3i> voxels =
      voxels_where(5, [&](Vec3i v) { return v.x <= 30 && v.z <= 30 && is_wall(v); });
  for (const Vec3i half : {Vec3i{1, 2, 1}, Vec3i{1, 3, 1}, Vec3i{2, 2, 2}, Vec3i{0, 0, 0}})
    for (const Vec3i seed : {Vec3i{7, 8, 7}, Vec3i{7, 1, 7}, Vec3i{7, 3, 7}})
      expect_brute_carving(5, voxels, seed, half);
  const Svdag dag = brute_svdag(5, voxels);
  const auto wall = [&](Vec3i half) {
    return moments_of(carve(dag.view(), {7, 8, 7}, half, CarveForm::kWall).view(), {}).bounds;
  };
  EXPECT_EQ(wall({1, 2, 1}).hi.x, 31);
  EXPECT_EQ(wall({1, 3, 1}).hi.x, 16);
  EXPECT_EQ(wall({2, 2, 2}).hi.x, 16);
}

TEST(Carve, PlacesOutsideOfTheGridAreRefused) {
  const Svdag dag = brute_svdag(3, {{0, 0, 0}, {7, 7, 7}});
  for (const Vec3i seed : {Vec3i{-1, 3, 3}, Vec3i{3, 8, 3}, Vec3i{3, 3, 1 << 20}})
    EXPECT_ANY_THROW(carve(dag.view(), seed, {0, 0, 0}, CarveForm::kWall));
  EXPECT_ANY_THROW(carve(brute_svdag(3, {}).view(), {1, 1, 1}, {0, 0, 0}, CarveForm::kWall));
}

TEST(Carve, CapsulesAreRoundedUpToVoxels) {
  EXPECT_EQ(half_of_capsule(1.6, 0.3, 1, 0.1), (Vec3i{3, 8, 3}));
  EXPECT_EQ(half_of_capsule(1.5, 0.25, 2, 0.5), (Vec3i{1, 1, 2}));
  EXPECT_EQ(half_of_capsule(1e300, 0, 0, 0.5), (Vec3i{1 << 20, 0, 0}));
  const Grid grid{3, {-1, 0, 2}, 0.5};
  EXPECT_EQ(voxel_at(grid, {-0.9, 0.5, 3.9}), (Vec3i{0, 1, 3}));
  EXPECT_EQ(voxel_at(grid, {-5, 1e30, 2}), (Vec3i{-1, 8, 0}));
}

}  // namespace
}  // namespace voxdag
