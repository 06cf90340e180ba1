// Queries against loops over all voxels.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "support/brute_svdag.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/algebra/query/distance_field.hpp"
#include "voxdag/algebra/query/height_map.hpp"
#include "voxdag/algebra/query/nearest_voxel.hpp"
#include "voxdag/algebra/query/surface_area.hpp"
#include "voxdag/algebra/query/voxel_moments.hpp"

namespace voxdag {
namespace {

double distance2(Vec3d p, Vec3i v) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = std::max({v[axis] - p[axis], p[axis] - v[axis] - 1, 0.0});
    sum += d * d;
  }
  return sum;
}

bool is_in(Vec3d p, Vec3i v) {
  for (int axis = 0; axis < 3; ++axis)
    if (std::floor(p[axis]) != v[axis]) return false;
  return true;
}

/// Returns the nearest voxel by looking at all of them.
std::optional<NearestVoxel> brute_nearest(const std::vector<Vec3i>& voxels, Vec3d p) {
  std::optional<NearestVoxel> best;
  for (const Vec3i v : voxels) {
    if (is_in(p, v)) return NearestVoxel{v, 0};
    const double d = distance2(p, v);
    const auto order = [](Vec3i a) { return std::array{a.x, a.y, a.z}; };
    if (!best || d < best->distance2 || (d == best->distance2 && order(v) < order(best->voxel)))
      best = NearestVoxel{v, d};
  }
  return best;
}

TEST(NearestVoxel, IsTheNearestOfAll) {
  for (const int levels : {2, 3, 5})
    for (const NamedVoxels& set : voxel_sets(levels, 3)) {
      SCOPED_TRACE(set.name + ", " + std::to_string(levels) + " levels");
      const Svdag dag = brute_svdag(levels, set.voxels);
      std::mt19937 rng(static_cast<unsigned>(levels));
      const double side = 1 << levels;
      std::uniform_real_distribution<double> near(-0.5 * side, 1.5 * side);
      for (int i = 0; i < 200; ++i) {
        Vec3d p{near(rng), near(rng), near(rng)};
        // Ties: points on the lattice, and in the middle of voxels.
        if (i % 3 == 1) p = Vec3d{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
        if (i % 3 == 2) p = Vec3d{std::floor(p.x) + 0.5, std::floor(p.y) + 0.5, std::floor(p.z)};
        const auto found = nearest_voxel(dag.view(), p), expected = brute_nearest(set.voxels, p);
        ASSERT_EQ(found.has_value(), expected.has_value());
        if (!found) continue;
        EXPECT_EQ(found->voxel, expected->voxel);
        EXPECT_EQ(found->distance2, expected->distance2);
        // A limit hides voxels beyond it, and no others.
        EXPECT_TRUE(nearest_voxel(dag.view(), p, expected->distance2).has_value());
        const auto closer = nearest_voxel(dag.view(), p, expected->distance2 * 0.999);
        EXPECT_EQ(closer.has_value(), expected->distance2 == 0);
      }
    }
}

TEST(NearestVoxel, NothingIsNearAnEmptyDagOrAPointThatIsNone) {
  Svdag empty;
  empty.levels = 6;
  EXPECT_FALSE(nearest_voxel(empty.view(), {1, 2, 3}));
  const Svdag dag = brute_svdag(4, {{1, 2, 3}});
  EXPECT_FALSE(nearest_voxel(dag.view(), {std::nan(""), 2, 3}));
  EXPECT_FALSE(nearest_voxel(dag.view(), {HUGE_VAL, 2, 3}));
  EXPECT_EQ(nearest_voxel(dag.view(), {1e9, 2, 3})->voxel, (Vec3i{1, 2, 3}));
}

/// Returns the distance from the centre of a place to the nearest voxel, by looking at all of them.
float brute_distance(const std::vector<Vec3i>& voxels, Vec3i place) {
  const auto nearest = brute_nearest(voxels, static_cast<Vec3d>(place) + Vec3d{0.5, 0.5, 0.5});
  return nearest ? static_cast<float>(std::sqrt(nearest->distance2)) : HUGE_VALF;
}

/// Calls body(place, index) for the places of a box, in the order of distance fields.
template <class Body>
void for_each_place_of(const Box3i& box, const Body& body) {
  std::size_t i = 0;
  for (std::int32_t z = box.lo.z; z < box.hi.z; ++z)
    for (std::int32_t y = box.lo.y; y < box.hi.y; ++y)
      for (std::int32_t x = box.lo.x; x < box.hi.x; ++x) body(Vec3i{x, y, z}, i++);
}

/// Windows that hold the grid of 16³, lie in it, cross it, are far from it, and are so long that
/// squared distances do not fit into 32 bits.
const Box3i kWindows[] = {{{0, 0, 0}, {16, 16, 16}},    {{-3, 4, 2}, {18, 12, 19}},
                          {{-2, -5, -1}, {17, 19, 23}}, {{5, 6, 7}, {9, 8, 8}},
                          {{40, 3, -50}, {43, 9, -48}}, {{-16500, 3, 4}, {16500, 4, 5}}};

TEST(DistanceField, IsTheDistanceToTheNearestOfAll) {
  for (const NamedVoxels& set : voxel_sets(4, 5)) {
    const Svdag dag = brute_svdag(4, set.voxels);
    for (const Box3i& box : kWindows) {
      const Vec3l size = Vec3l(box.hi) - Vec3l(box.lo);
      if (size.x * size.y * size.z * static_cast<std::int64_t>(set.voxels.size()) > 2'000'000)
        continue;
      const std::vector<float> distances = distance_field(dag.view(), box, {});
      for_each_place_of(box, [&](Vec3i place, std::size_t i) {
        ASSERT_EQ(distances[i], brute_distance(set.voxels, place))
            << set.name << " " << place.x << "," << place.y << "," << place.z;
      });
    }
  }
}

TEST(DistanceField, OfRandomSetsIsExactAlongLongLines) {
  std::mt19937 rng(3);
  std::vector<Vec3i> voxels;
  for (int i = 0; i < 12; ++i)
    voxels.push_back(
        {static_cast<int>(rng() % 512), static_cast<int>(rng() % 8), static_cast<int>(rng() % 8)});
  const Svdag dag = brute_svdag(9, voxels);
  const Box3i box{{0, 0, 0}, {512, 9, 9}};
  const std::vector<float> distances = distance_field(dag.view(), box, {});
  for_each_place_of(box, [&](Vec3i place, std::size_t i) {
    ASSERT_EQ(distances[i], brute_distance(voxels, place));
  });
}

TEST(SignedDistanceField, IsNegativeInVoxels) {
  for (const NamedVoxels& set : voxel_sets(3, 5)) {
    const Svdag dag = brute_svdag(3, set.voxels);
    const auto order = [](Vec3i a) { return std::array{a.x, a.y, a.z}; };
    std::set<std::array<int, 3>> inside;
    for (const Vec3i v : set.voxels) inside.insert(order(v));
    std::vector<Vec3i> empty;
    for_each_place_of({{-1, -1, -1}, {9, 9, 9}}, [&](Vec3i place, std::size_t) {
      if (!inside.contains(order(place))) empty.push_back(place);
    });
    // The grid; a part of it; places around it; the middle, far from the empty places of a solid.
    for (const Box3i& box : {Box3i{{0, 0, 0}, {8, 8, 8}}, Box3i{{1, 2, 0}, {7, 4, 5}},
                             Box3i{{-2, 6, -1}, {9, 11, 3}}, Box3i{{3, 3, 3}, {5, 5, 5}}}) {
      const std::vector<float> distances = signed_distance_field(dag.view(), box, {});
      for_each_place_of(box, [&](Vec3i place, std::size_t i) {
        ASSERT_EQ(distances[i], inside.contains(order(place)) ? -brute_distance(empty, place)
                                                              : brute_distance(set.voxels, place))
            << set.name << " " << place.x << "," << place.y << "," << place.z;
      });
    }
  }
}

TEST(VoxelMoments, AreThoseOfAllVoxels) {
  for (const int levels : {2, 3, 6})
    for (const NamedVoxels& set : voxel_sets(levels, 6)) {
      const VoxelMoments moments = moments_of(brute_svdag(levels, set.voxels).view(), {});
      Vec3l sum;
      Box3i bounds = Box3i::empty();
      for (const Vec3i v : set.voxels) {
        sum = sum + Vec3l(v);
        bounds.extend(v);
      }
      const auto count = static_cast<double>(set.voxels.size());
      EXPECT_EQ(moments.voxels, set.voxels.size()) << set.name;
      if (set.voxels.empty()) continue;
      EXPECT_EQ(moments.bounds, (Box3i{bounds.lo, bounds.hi + Vec3i{1, 1, 1}})) << set.name;
      for (int axis = 0; axis < 3; ++axis)
        EXPECT_DOUBLE_EQ(moments.centre[axis], static_cast<double>(sum[axis]) / count + 0.5);
    }
  // The farthest voxel of the largest grid.
  const std::int32_t last = (1 << kMaxLevels) - 1;
  const VoxelMoments corner = moments_of(brute_svdag(kMaxLevels, {{last, 0, last}}).view(), {});
  EXPECT_EQ(corner.centre, (Vec3d{last + 0.5, 0.5, last + 0.5}));
}

TEST(HeightMap, HasTheOutermostVoxelOfEachColumn) {
  for (const int levels : {2, 3, 5})
    for (const NamedVoxels& set : voxel_sets(levels, 4)) {
      const Svdag dag = brute_svdag(levels, set.voxels);
      const std::size_t side = std::size_t{1} << levels;
      for (int axis = 0; axis < 3; ++axis)
        for (const HeightSide end : {HeightSide::kHigh, HeightSide::kLow}) {
          std::vector<std::int32_t> expected(side * side, -1);
          for (const Vec3i v : set.voxels) {
            const int u = axis == 0 ? 1 : 0, w = axis == 2 ? 1 : 2;
            std::int32_t& height =
                expected[static_cast<std::size_t>(v[u]) + side * static_cast<std::size_t>(v[w])];
            const bool is_farther = end == HeightSide::kHigh ? v[axis] > height : v[axis] < height;
            if (height < 0 || is_farther) height = v[axis];
          }
          ASSERT_EQ(height_map(dag.view(), axis, end, {}), expected)
              << set.name << ", " << levels << " levels, axis " << axis;
        }
    }
}

TEST(SurfaceArea, CountsTheFacesThatNoOtherVoxelTouches) {
  for (const int levels : {2, 4})
    for (const NamedVoxels& set : voxel_sets(levels, 6)) {
      const Svdag dag = brute_svdag(levels, set.voxels);
      std::set<std::array<int, 3>> all;
      for (const Vec3i v : set.voxels) all.insert({v.x, v.y, v.z});
      const VoxelSurface surface = surface_of(dag.view(), {});
      EXPECT_EQ(surface.voxels, all.size());
      for (int axis = 0; axis < 3; ++axis) {
        std::uint64_t faces = 0;
        for (const auto& v : all)
          for (const int step : {-1, 1}) {
            auto beside = v;
            beside[static_cast<std::size_t>(axis)] += step;
            faces += all.count(beside) == 0 ? 1 : 0;
          }
        EXPECT_EQ(surface.faces[axis], faces) << set.name;
      }
    }
}

}  // namespace
}  // namespace voxdag
