#include "voxdag/builders/esvo/build/build_esvo.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/displaced_crate.hpp"
#include "support/grid_mesh.hpp"
#include "support/random_triangles.hpp"
#include "support/with_threads.hpp"
#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/esvo/build/check_esvo.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/stored/svdag/for_each_voxel.hpp"

namespace voxdag {
namespace {

/// Returns random triangles with vertices at multiples of 1/256 voxel. World units are voxels.
Mesh random_mesh(std::uint64_t seed, int levels, int triangles) {
  std::mt19937_64 random(seed);
  Mesh mesh;
  for (int i = 0; i < triangles; ++i) {
    const QuantizedTriangle t = random_triangle(random, levels);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int k = 0; k < 3; ++k)
      mesh.vertices.push_back(static_cast<Vec3f>(t[k]) * (1.0f / kSubvoxels));
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

Grid unit_grid(int levels) { return {levels, {0, 0, 0}, 1.0, kSubvoxels}; }

/// Returns a sphere around `centre` of 2 * n² triangles.
Mesh sphere_mesh(Vec3f centre, float radius, int n) {
  return test::grid_mesh(n, [=](int i, int j) {
    const float a = 3.14159265f * static_cast<float>(i) / static_cast<float>(n);
    const float b = 6.2831853f * static_cast<float>(j % n) / static_cast<float>(n);
    return centre +
           Vec3f{std::sin(a) * std::cos(b), std::cos(a), std::sin(a) * std::sin(b)} * radius;
  });
}

struct Leaf {
  int level;
  Vec3i cell;
};

std::vector<Leaf> leaves_of(const EsvoView& esvo) {
  std::vector<Leaf> leaves;
  const auto walk = [&](const auto& self, std::uint64_t slot, int level, Vec3i cell) -> void {
    const ChildDescriptor d = esvo.descriptor(slot);
    for (int i = 0; i < 8; ++i) {
      const Vec3i at = cell * 2 + child_offset(i);
      if ((d.leaf_mask() >> i & 1) != 0)
        leaves.push_back({level + 1, at});
      else if ((d.valid_mask() >> i & 1) != 0)
        self(self, esvo.child(slot, d, i), level + 1, at);
    }
  };
  if (!esvo.is_empty()) walk(walk, esvo.root, 0, {});
  return leaves;
}

std::vector<std::uint64_t> codes_of_voxels(const SvdagView& dag) {
  std::vector<std::uint64_t> codes;
  for_each_voxel(dag, whole_grid(dag.levels), [&](Vec3i v) { codes.push_back(morton_encode(v)); });
  return codes;
}

EsvoOptions cubes() {
  EsvoOptions options;
  options.settings.contours = false;
  return options;
}

TEST(BuildEsvo, CubesAreTheVoxelsOfTheExactCover) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const int levels = 2 + static_cast<int>(seed % 6);
    const Mesh mesh = random_mesh(seed, levels, 1 + static_cast<int>(seed % 40));
    const Esvo esvo = build_esvo(mesh, unit_grid(levels), cubes());
    std::vector<std::uint64_t> codes;
    for (const Leaf& leaf : leaves_of(esvo.view())) {
      ASSERT_EQ(leaf.level, levels);
      codes.push_back(morton_encode(leaf.cell));
    }
    EXPECT_EQ(codes, codes_of_voxels(build_svdag(mesh, unit_grid(levels)).dag.view())) << seed;
  }
}

TEST(BuildEsvo, LeavesWithContoursCoverTheSameVoxels) {
  for (std::uint64_t seed = 100; seed < 120; ++seed) {
    const int levels = 2 + static_cast<int>(seed % 6);
    const Mesh mesh = random_mesh(seed, levels, 20);
    const Esvo esvo = build_esvo(mesh, unit_grid(levels));
    const Svdag dag = build_svdag(mesh, unit_grid(levels)).dag;
    std::vector<std::uint64_t> cells, expected;
    for (const Leaf& leaf : leaves_of(esvo.view()))
      cells.push_back(morton_encode(leaf.cell) << 3 * (levels - leaf.level) << 8 |
                      static_cast<std::uint64_t>(leaf.level));
    // Every voxel is in one leaf, and every leaf contains a voxel.
    std::size_t at = 0;
    for (const std::uint64_t code : codes_of_voxels(dag.view())) {
      while (at < cells.size() &&
             (code >> 3 * (levels - static_cast<int>(cells[at] & 255))) !=
                 (cells[at] >> 8 >> 3 * (levels - static_cast<int>(cells[at] & 255))))
        ++at;
      ASSERT_LT(at, cells.size()) << seed;
    }
    EXPECT_EQ(at + 1, cells.size()) << seed;
  }
}

TEST(BuildEsvo, ContoursEncloseTheSurface) {
  for (std::uint64_t seed = 200; seed < 240; ++seed) {
    const int levels = 2 + static_cast<int>(seed % 9);
    const Mesh mesh = random_mesh(seed, levels, 1 + static_cast<int>(seed % 30));
    const Grid grid = unit_grid(levels);
    EsvoOptions options;
    options.settings.max_error = seed % 2 == 0 ? 0.5f : 4.0f;
    options.settings.normal_error = 3;
    const Esvo esvo = build_esvo(mesh, grid, options);
    const EnclosureCheck check =
        check_enclosure(esvo.view(), {mesh, grid}, grid, nullptr, nullptr, 5000);
    EXPECT_GT(check.points, 1000u);
    EXPECT_FALSE(check.outside.has_value())
        << "seed " << seed << " triangle " << check.outside->triangle << " level "
        << check.outside->level << " of " << levels;
  }
}

TEST(BuildEsvo, ContoursOfCellsWithVeryManyTrianglesEncloseTheSurface) {
  const Mesh sheet = test::grid_mesh(300, [](int i, int j) {
    const float x = static_cast<float>(i) / 300, y = static_cast<float>(j) / 300;
    return Vec3f{250 * x, 250 * y, 120 + 60 * std::sin(5 * x) * std::cos(4 * y)};
  });
  const Grid grid = unit_grid(8);
  Appearance appearance;
  appearance.materials.resize(1);
  const DisplacedTriangles displaced(sheet, appearance,
                                     displace_all(sheet, appearance, stones(), 5, 40));
  for (const DisplacedTriangles* const by :
       {static_cast<const DisplacedTriangles*>(nullptr), &displaced}) {
    EsvoMemory memory;
    const EsvoResult result = build_esvo(sheet, grid, {}, nullptr, by, memory);
    const std::vector<std::uint64_t> slots = memory.take();
    const EsvoView view{slots.data(), slots.size(), result.root, 8};
    const ChildDescriptor root = view.descriptor(view.root);
    EXPECT_NE(root.contour_mask(), 0u);
    const EnclosureCheck check = check_enclosure(view, {sheet, grid}, grid, nullptr, by, 20000);
    EXPECT_GT(check.points, 15000u);
    EXPECT_FALSE(check.outside.has_value());
  }
}

TEST(BuildEsvo, ContoursMakePlanesAndSpheresOfFewVoxels) {
  // A slanted plane across the grid: a few contours represent it.
  Mesh plane;
  plane.vertices = {{0, 0, 10}, {64, 0, 20}, {64, 64, 50}, {0, 64, 40}};
  plane.triangles = {{0, 1, 2}, {0, 2, 3}};
  const std::size_t flat = leaves_of(build_esvo(plane, unit_grid(6)).view()).size();
  EXPECT_LT(flat * 40, leaves_of(build_esvo(plane, unit_grid(6), cubes()).view()).size());

  const Mesh sphere = sphere_mesh({128, 128, 128}, 100, 100);
  const std::size_t contours = leaves_of(build_esvo(sphere, unit_grid(8)).view()).size();
  const std::size_t voxels = leaves_of(build_esvo(sphere, unit_grid(8), cubes()).view()).size();
  EXPECT_LT(contours * 4, voxels);
}

TEST(BuildEsvo, AFinelyTriangulatedWallEndsAsEarlyAsACoarseOne) {
  const auto leaves = [](int n) {
    const Mesh wall = test::grid_mesh(n, [=](int i, int j) {
      const float x = 64.0f * static_cast<float>(i) / static_cast<float>(n),
                  y = 64.0f * static_cast<float>(j) / static_cast<float>(n);
      return Vec3f{x, y, 10 + x * (10.0f / 64) + y * (30.0f / 64)};
    });
    return leaves_of(build_esvo(wall, unit_grid(6)).view()).size();
  };
  const std::size_t coarse = leaves(1);
  EXPECT_LT(coarse, 40u);
  for (const int n : {4, 16, 64, 128}) EXPECT_LE(leaves(n), coarse) << n;
}

TEST(BuildEsvo, SameBytesForAnyNumberOfThreads) {
  Mesh mesh = random_mesh(7, 8, 200);
  EsvoOptions options;
  options.pack.max_slots = 500;
  const auto build = [&](int threads) {
    return with_threads(threads, [&] { return build_esvo(mesh, unit_grid(8), options); });
  };
  const Esvo one = build(1);
  EXPECT_EQ(build(2), one);
  EXPECT_EQ(build(7), one);
}

TEST(BuildEsvo, TheDirectoryListsTheBlocksAndTheirParents) {
  const Mesh mesh = random_mesh(9, 9, 300);
  EsvoOptions options;
  options.pack.max_slots = 300;
  EsvoMemory memory;
  const EsvoResult result = build_esvo(mesh, unit_grid(9), options, nullptr, nullptr, memory);
  const std::vector<std::uint64_t> slots = memory.take();
  const EsvoView view{slots.data(), slots.size(), result.root, 9};
  ASSERT_GT(result.directory.size(), 10u);
  std::uint64_t end = 0;
  for (const EsvoBlockEntry& block : result.directory) {
    EXPECT_EQ(block.begin, end);
    end += block.slots;
    const std::uint64_t first = block.begin + view.info(block.begin).first_descriptor;
    if (block.parent == EsvoBlockEntry::kNoParent) {
      EXPECT_EQ(first, result.root);
      continue;
    }
    const ChildDescriptor parent = view.descriptor(block.parent);
    ASSERT_TRUE(parent.is_far());
    EXPECT_EQ(view.first_child(block.parent, parent), first);
  }
  EXPECT_EQ(end, slots.size());
  const std::vector<Leaf> leaves = leaves_of(view);
  EXPECT_EQ(result.counts.leaves(), leaves.size());
  EXPECT_EQ(result.counts.blocks, result.directory.size());
}

TEST(BuildEsvo, AMeshOutsideOfTheGridGivesAnEmptyOctree) {
  Mesh mesh;
  mesh.vertices = {{100, 100, 100}, {101, 100, 100}, {100, 101, 100}};
  mesh.triangles = {{0, 1, 2}};
  EXPECT_TRUE(build_esvo(mesh, unit_grid(4)).view().is_empty());
}

TEST(BuildEsvo, PointsAndNeedlesOutsideOfTheGridGiveNothing) {
  // Points and needles have no edge conditions: only their boxes keep them out of a voxel at the
  // grid's side.
  Mesh mesh;
  mesh.vertices = {{-3, 5, 5}, {5, -9, 5}, {5, 5, 20}, {-3, 5, 5.5f}};
  mesh.triangles = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {0, 3, 3}};
  EXPECT_TRUE(build_esvo(mesh, unit_grid(4)).view().is_empty());
  EXPECT_TRUE(build_esvo(mesh, unit_grid(4), cubes()).view().is_empty());
}

TEST(BuildEsvo, AGridThatCutsTheMeshHasTheVoxelsOfTheExactCover) {
  for (std::uint64_t seed = 300; seed < 330; ++seed) {
    const int levels = 3 + static_cast<int>(seed % 4);
    const Mesh mesh = random_mesh(seed, levels, 60);
    const double n = static_cast<double>(std::int64_t{1} << levels);
    const Grid grid{levels, {n / 3, n / 5, -n / 4}, 0.5, 2 * kSubvoxels};
    std::vector<std::uint64_t> codes;
    for (const Leaf& leaf : leaves_of(build_esvo(mesh, grid, cubes()).view()))
      codes.push_back(morton_encode(leaf.cell));
    EXPECT_EQ(codes, codes_of_voxels(build_svdag(mesh, grid).dag.view())) << seed;
  }
}

}  // namespace
}  // namespace voxdag
