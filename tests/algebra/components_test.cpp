#include "voxdag/algebra/components.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "voxdag/algebra/empty_regions.hpp"
#include "voxel_grid.hpp"

namespace voxdag {
namespace {

/// Connected regions of the places of a grid at which wanted(v) holds, by flooding.
class FloodedRegions {
 public:
  template <class Wanted>
  FloodedRegions(int levels, Neighbours neighbours, const Wanted& wanted)
      : side_(1 << levels), regions_(std::size_t{1} << (3 * levels), kNone) {
    for (std::int32_t z = 0; z < side_; ++z)
      for (std::int32_t y = 0; y < side_; ++y)
        for (std::int32_t x = 0; x < side_; ++x)
          if (wanted(Vec3i{x, y, z}) && region({x, y, z}) == kNone)
            flood({x, y, z}, neighbours, wanted);
  }

  static constexpr int kNone = -1;
  /// Returns the region of a place; kNone: not wanted.
  int& region(Vec3i v) {
    return regions_[static_cast<std::size_t>((v.z * side_ + v.y) * side_ + v.x)];
  }
  const std::vector<std::uint64_t>& sizes() const { return sizes_; }
  bool reaches_the_sides(int region) const { return reaches_[static_cast<std::size_t>(region)]; }

 private:
  template <class Wanted>
  void flood(Vec3i first, Neighbours neighbours, const Wanted& wanted) {
    const int number = static_cast<int>(sizes_.size());
    sizes_.push_back(0);
    reaches_.push_back(false);
    std::vector<Vec3i> stack = {first};
    region(first) = number;
    while (!stack.empty()) {
      const Vec3i v = stack.back();
      stack.pop_back();
      ++sizes_.back();
      for (int axis = 0; axis < 3; ++axis)
        if (v[axis] == 0 || v[axis] == side_ - 1) reaches_.back() = true;
      for (int i = 0; i < 27; ++i) {
        const Vec3i step{i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1}, next = v + step;
        if (neighbours == Neighbours::k6 && dot(step, step) > 1) continue;
        if (std::min({next.x, next.y, next.z}) < 0 || std::max({next.x, next.y, next.z}) >= side_)
          continue;
        if (!wanted(next) || region(next) != kNone) continue;
        region(next) = number;
        stack.push_back(next);
      }
    }
  }

  std::int32_t side_;
  std::vector<int> regions_;
  std::vector<std::uint64_t> sizes_;
  std::vector<bool> reaches_;
};

/// Returns sets whose voxels have many components and cavities.
std::vector<NamedVoxels> porous_sets(int levels) {
  std::vector<NamedVoxels> sets = voxel_sets(levels, 5);
  for (const int percent : {8, 30, 45, 60, 75, 92}) {
    std::mt19937 rng(static_cast<unsigned>(percent));
    sets.push_back({std::to_string(percent) + "%", voxels_where(levels, [&](Vec3i) {
                      return static_cast<int>(rng() % 100) < percent;
                    })});
  }
  // Nested boxes, and boxes that a hole opens.
  sets.push_back(
      {"boxes", voxels_where(levels, [&](Vec3i v) {
         const std::int32_t last = (1 << levels) - 1;
         const std::int32_t in = std::min({v.x, v.y, v.z, last - v.x, last - v.y, last - v.z});
         const bool is_hole = in == 2 && v.x == 3 && v.y == 4;
         return in % 2 == 0 && !is_hole;
       })});
  return sets;
}

constexpr Neighbours kBoth[] = {Neighbours::k6, Neighbours::k26};

TEST(Components, TheirSizesAreThoseOfAFlood) {
  for (const int levels : {2, 3, 4, 5})
    for (const NamedVoxels& set : porous_sets(levels)) {
      const VoxelGrid grid(levels, set.voxels);
      const Svdag dag = brute_svdag(levels, set.voxels);
      for (const Neighbours neighbours : kBoth) {
        const FloodedRegions flooded(levels, neighbours, [&](Vec3i v) { return grid.contains(v); });
        std::map<std::uint64_t, std::uint64_t, std::greater<>> counts;
        for (const std::uint64_t size : flooded.sizes()) ++counts[size];
        std::vector<ComponentSizes> expected;
        for (const auto& [voxels, count] : counts) expected.push_back({voxels, count});
        ASSERT_EQ(component_sizes(dag.view(), neighbours), expected)
            << set.name << ", " << levels << " levels";
      }
    }
}

TEST(Components, ThoseThatAreKeptAreThoseOfAFlood) {
  for (const int levels : {2, 3, 4})
    for (const NamedVoxels& set : porous_sets(levels)) {
      const VoxelGrid grid(levels, set.voxels);
      const Svdag dag = brute_svdag(levels, set.voxels);
      for (const Neighbours neighbours : kBoth) {
        FloodedRegions flooded(levels, neighbours, [&](Vec3i v) { return grid.contains(v); });
        for (const std::uint64_t least : {1u, 2u, 3u, 7u, 40u, 5000u})
          ASSERT_EQ(keep_components(dag.view(), least, neighbours),
                    VoxelGrid::dag_of(
                        levels,
                        [&](Vec3i v) {
                          return grid.contains(v) &&
                                 flooded.sizes()[static_cast<std::size_t>(flooded.region(v))] >=
                                     least;
                        }))
              << set.name << ", " << levels << " levels, " << least;
      }
    }
}

TEST(Components, CavitiesAreFilled) {
  for (const int levels : {2, 3, 4, 5})
    for (const NamedVoxels& set : porous_sets(levels)) {
      const VoxelGrid grid(levels, set.voxels);
      const Svdag dag = brute_svdag(levels, set.voxels);
      FloodedRegions flooded(levels, Neighbours::k6, [&](Vec3i v) { return !grid.contains(v); });
      ASSERT_EQ(fill_cavities(dag.view()),
                VoxelGrid::dag_of(levels,
                                  [&](Vec3i v) {
                                    return grid.contains(v) ||
                                           !flooded.reaches_the_sides(flooded.region(v));
                                  }))
          << set.name << ", " << levels << " levels";
    }
}

TEST(EmptyRegions, EachMayBeFilled) {
  for (const int levels : {2, 3, 4, 5})
    for (const NamedVoxels& set : porous_sets(levels)) {
      if (set.voxels.empty()) continue;
      SCOPED_TRACE(set.name + ", " + std::to_string(levels) + " levels");
      const VoxelGrid grid(levels, set.voxels);
      const Svdag dag = brute_svdag(levels, set.voxels);
      FloodedRegions flooded(levels, Neighbours::k6, [&](Vec3i v) { return !grid.contains(v); });
      const EmptyRegions regions(dag.view());
      ASSERT_EQ(regions.places().size(), flooded.sizes().size());
      std::mt19937 rng(static_cast<unsigned>(levels));
      std::vector<bool> is_filled(regions.places().size()), of_flooded = is_filled,
                                                            is_met = is_filled;
      for (std::size_t i = 0; i < is_filled.size(); ++i) {
        const int region = flooded.region(regions.places()[i]);
        ASSERT_GE(region, 0);
        const auto at = static_cast<std::size_t>(region);
        EXPECT_FALSE(is_met[at]) << "two places of one region";
        is_met[at] = true;
        is_filled[i] = of_flooded[at] = rng() % 2 == 0;
      }
      ASSERT_EQ(regions.fill(is_filled), VoxelGrid::dag_of(levels, [&](Vec3i v) {
                  return grid.contains(v) ||
                         of_flooded[static_cast<std::size_t>(flooded.region(v))];
                }));
    }
}

/// Returns a hollow box of a huge grid.
Svdag huge_shell(int levels, std::int32_t low, std::int32_t high) {
  std::vector<Vec3i> voxels;
  for (std::int32_t z = low; z <= high; ++z)
    for (std::int32_t y = low; y <= high; ++y)
      for (std::int32_t x = low; x <= high; ++x)
        if (std::min({x, y, z}) == low || std::max({x, y, z}) == high) voxels.push_back({x, y, z});
  return brute_svdag(levels, voxels);
}

TEST(Components, OfHugeGridsAreFound) {
  const Svdag shell = huge_shell(18, 131'060, 131'085);
  const std::uint64_t voxels = 26 * 26 * 26 - 24 * 24 * 24;
  EXPECT_EQ(component_sizes(shell.view(), Neighbours::k6),
            (std::vector<ComponentSizes>{{voxels, 1}}));
  const Svdag filled = fill_cavities(shell.view());
  EXPECT_EQ(component_sizes(filled.view(), Neighbours::k26),
            (std::vector<ComponentSizes>{{26 * 26 * 26, 1}}));
}

TEST(Components, AnEmptyDagHasNone) {
  Svdag empty;
  empty.levels = 7;
  EXPECT_TRUE(component_sizes(empty.view(), Neighbours::k26).empty());
  EXPECT_EQ(fill_cavities(empty.view()), empty);
  EXPECT_EQ(keep_components(empty.view(), 1, Neighbours::k6), empty);
}

}  // namespace
}  // namespace voxdag
