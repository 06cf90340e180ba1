#include "voxdag/formats/exports/bit_planes.hpp"

#include <gtest/gtest.h>

#include <set>

#include "exported_scene.hpp"

namespace voxdag {
namespace {

constexpr PlaneAxes kAxes[] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};

/// Returns the voxels of the scene in a box.
std::set<VoxelKey> inside(const ExportedScene& scene, const Box3i& box) {
  std::set<VoxelKey> set;
  for (const Vec3i v : scene.voxels)
    if (v.x >= box.lo.x && v.y >= box.lo.y && v.z >= box.lo.z && v.x < box.hi.x && v.y < box.hi.y &&
        v.z < box.hi.z)
      set.insert({v.x, v.y, v.z});
  return set;
}

VoxelKey key(const Box3i& box, PlaneAxes axes, std::int32_t k, std::int32_t row,
             std::int32_t column) {
  Vec3i voxel = box.lo;
  voxel[axes.plane] = k;
  voxel[axes.row] += row;
  voxel[axes.column] += column;
  return {voxel.x, voxel.y, voxel.z};
}

TEST(BitPlanes, HoldTheVoxelsOfTheBox) {
  const ExportedScene scene(7, 2000);
  for (const Box3i& box :
       {whole_grid(7), Box3i{{3, 18, 1}, {90, 127, 6}}, Box3i{{5, 5, 5}, {6, 6, 6}}})
    for (const PlaneAxes axes : kAxes) {
      std::set<VoxelKey> found, before_found;
      std::int32_t next = box.lo[axes.plane];
      for_each_plane(scene.view(), box, axes,
                     [&](std::int32_t k, const BitPlane& plane, const BitPlane* before) {
                       EXPECT_EQ(k, next++);
                       EXPECT_EQ(before == nullptr, k == box.lo[axes.plane]);
                       for (std::int32_t row = 0; row < plane.rows(); ++row)
                         for_each_run(plane.row(row), [&](std::int32_t begin, std::int32_t end) {
                           EXPECT_TRUE(plane.has_bits(row));
                           for (std::int32_t i = begin; i < end; ++i)
                             found.insert(key(box, axes, k, row, i));
                         });
                       for (std::int32_t row = 0; before != nullptr && row < plane.rows(); ++row)
                         for_each_run(before->row(row), [&](std::int32_t begin, std::int32_t end) {
                           for (std::int32_t i = begin; i < end; ++i)
                             before_found.insert(key(box, axes, k - 1, row, i));
                         });
                     });
      EXPECT_EQ(next, box.hi[axes.plane]);
      EXPECT_EQ(found, inside(scene, box));
      Box3i all_but_last = box;
      --all_but_last.hi[axes.plane];
      EXPECT_EQ(before_found, inside(scene, all_but_last));
    }
}

TEST(BitPlanes, RowsComeInOrder) {
  const ExportedScene scene(5, 400);
  const Box3i box{{1, 2, 3}, {30, 31, 32}};
  for (const PlaneAxes axes : kAxes) {
    std::set<VoxelKey> found;
    std::pair<std::int32_t, std::int32_t> next{box.lo[axes.plane], 0};
    for_each_row(scene.view(), box, axes,
                 [&](std::int32_t k, std::int32_t row, std::span<const std::uint64_t> bits) {
                   EXPECT_EQ(std::pair(k, row), next);
                   next = row + 1 == box.hi[axes.row] - box.lo[axes.row] ? std::pair(k + 1, 0)
                                                                         : std::pair(k, row + 1);
                   for_each_run(bits, [&](std::int32_t begin, std::int32_t end) {
                     for (std::int32_t i = begin; i < end; ++i)
                       found.insert(key(box, axes, k, row, i));
                   });
                 });
    EXPECT_EQ(next, std::pair(box.hi[axes.plane], 0));
    EXPECT_EQ(found, inside(scene, box));
  }
}

TEST(BitPlanes, BandsCoverTheBoxOnce) {
  const Box3i box{{0, 10, 20}, {5, 110, 84}};
  std::int32_t next = 10;
  // Six planes of one word, and a byte each, take 54 bytes a row.
  for_each_band(box, {0, 1, 2}, 54 * 7, [&](const Box3i& band) {
    EXPECT_EQ(band.lo, (Vec3i{0, next, 20}));
    EXPECT_EQ(band.hi, (Vec3i{5, std::min(next + 7, 110), 84}));
    next = band.hi.y;
  });
  EXPECT_EQ(next, 110);
}

TEST(BitPlanes, RunsAreTheBitsThatAreSet) {
  for (const std::vector<std::uint64_t>& row : {std::vector<std::uint64_t>{},
                                                {0},
                                                {~std::uint64_t{0}},
                                                {~std::uint64_t{0}, ~std::uint64_t{0}},
                                                {std::uint64_t{1} << 63, 1},
                                                {0x8000000000000001, 0, 0xF0F0},
                                                {5, ~std::uint64_t{0}, 3}}) {
    std::vector<std::pair<int, int>> expected, runs;
    const int count = static_cast<int>(64 * row.size());
    const auto bit = [&](int i) {
      return i >= 0 && i < count && (row[static_cast<std::size_t>(i / 64)] >> (i % 64) & 1) != 0;
    };
    for (int i = 0; i < count; ++i) {
      if (!bit(i) || bit(i - 1)) continue;
      int end = i;
      while (bit(end)) ++end;
      expected.emplace_back(i, end);
    }
    for_each_run(row, [&](std::int32_t begin, std::int32_t end) { runs.emplace_back(begin, end); });
    EXPECT_EQ(runs, expected);
  }
}

}  // namespace
}  // namespace voxdag
