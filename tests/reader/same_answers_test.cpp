// Tests that include/voxdag.h gives the library's answers: hits of rays to the bit, attributes of
// all cells, and voxels of windows.
#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "reader/header_scene.hpp"
#include "support/number_colors.hpp"
#include "support/random_pages.hpp"
#include "voxdag/algebra/query/containing_voxel.hpp"
#include "voxdag/builders/dag/build_svdag.hpp"
#include "voxdag/builders/voxelize/grid_mapping.hpp"
#include "voxdag/cpu/trace_batch.hpp"
#include "voxdag/formats/scenes/scenes.hpp"

namespace voxdag {
namespace {

std::vector<Vec3i> all_voxels(int levels) {
  std::vector<Vec3i> voxels;
  for (std::uint64_t code = 0; code < std::uint64_t{1} << 3 * levels; ++code)
    voxels.push_back(morton_decode(code));
  return voxels;
}

/// Returns the bytes of a file with this DAG in this grid.
std::string file_in_grid(const Svdag& dag, const Grid& grid) {
  VdagMetadata metadata = example_metadata(dag.view());
  metadata.grid = grid;
  const TempDir dir;
  write_vdag(dir / "file.vdag", dag.view(), metadata);
  return read_text(dir / "file.vdag");
}

Grid odd_grid(int levels) {
  Grid grid;
  grid.levels = levels;
  grid.origin = {-1.7, 0.3, 12.9};
  grid.voxel_size = 0.037;
  return grid;
}

/// Returns rays of all kinds. Half of them aim at voxels.
std::vector<Ray> rays_at(const Svdag& dag, const Grid& grid, int count) {
  std::vector<Vec3i> voxels;
  for_each_voxel(dag.view(), whole_grid(grid.levels),
                 [&](Vec3i voxel) { voxels.push_back(voxel); });
  TestRays make(grid, static_cast<unsigned>(count));
  std::mt19937 rng(1);
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    rays.push_back(make.make(static_cast<RayKind>(i / 2 % static_cast<int>(RayKind::kCount))));
    if (i % 2 == 0 || voxels.empty()) continue;
    const Vec3d centre = Vec3d(voxels[rng() % voxels.size()]) + Vec3d{0.5, 0.5, 0.5};
    rays.back().direction = Vec3f(grid.to_world(centre) - Vec3d(rays.back().origin));
  }
  return rays;
}

/// Casts rays with the header, and with the library's tracer on the CPU.
void expect_equal_hits(const Svdag& dag, const Grid& grid, int count) {
  const HeaderScene header(file_in_grid(dag, grid));
  ASSERT_TRUE(header.is_open()) << header.error();
  const std::vector<Ray> rays = rays_at(dag, grid, count);
  std::vector<Hit> hits(rays.size());
  trace_batch(dag.view(), grid, rays, hits);
  int wrong = 0, met = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit found = header_cast(header.scene(), rays[i]);
    wrong += found == hits[i] && have_equal_bits(found.t, hits[i].t) ? 0 : 1;
    met += found.hit ? 1 : 0;
  }
  EXPECT_EQ(wrong, 0) << "of " << count << " rays";
  EXPECT_GE(met, dag.view().is_empty() ? 0 : count / 4);
}

TEST(ReaderRays, HitTheVoxelsOfTheLibraryInRandomScenes) {
  for (int levels = 2; levels <= 9; ++levels)
    for (const int voxels : {3, 60, 3000})
      expect_equal_hits(brute_svdag(levels, random_voxels(levels, voxels, 7)), odd_grid(levels),
                        15'000);
}

TEST(ReaderRays, HitTheVoxelsOfTheLibraryInFullAndEmptyGrids) {
  for (int levels = 2; levels <= 4; ++levels)
    expect_equal_hits(brute_svdag(levels, all_voxels(levels)), odd_grid(levels), 30'000);
  expect_equal_hits(brute_svdag(6, {}), odd_grid(6), 10'000);
  expect_equal_hits(brute_svdag(2, {}), odd_grid(2), 10'000);
}

TEST(ReaderRays, HitTheVoxelsOfTheLibraryInLargeGrids) {
  for (const int levels : {12, 16, 20})
    expect_equal_hits(brute_svdag(levels, random_voxels(levels, 2000, 3)), odd_grid(levels),
                      40'000);
}

TEST(ReaderRays, HitTheVoxelsOfTheLibraryInProceduralScenes) {
  for (const SceneInfo& info : scene_list()) {
    SCOPED_TRACE(info.name);
    const Mesh mesh = make_scene(info.name, {info.min_size, 1});
    const Grid grid = fit_grid(mesh, 9);
    expect_equal_hits(build_svdag(mesh, grid).dag, grid, 80'000);
  }
}

/// A DAG with attributes of every kind, made of blocks of every type.
struct ColoredScene {
  ColoredScene(int levels, int voxels, int finest, int precision)
      : dag(brute_svdag(levels, random_voxels(levels, voxels, 5))),
        numbers(dag.view(), finest),
        attributes(numbers.view().attributes),
        colors(random_pages(attributes.index.cells, precision, 1, 0.5)),
        normals(random_pages(attributes.index.cells, 7 - precision, 2, 0.9)) {}

  std::string bytes(bool has_colors, bool has_normals, bool has_materials) const {
    DagAttributesView chosen = attributes;
    chosen.colors = has_colors ? colors.view() : ValuePagesView{};
    chosen.normals = has_normals ? normals.view() : ValuePagesView{};
    if (!has_materials) chosen.materials = {};
    return vdag_file_bytes(dag, chosen);
  }

  Svdag dag;
  NumberColors numbers;
  DagAttributesView attributes;
  ValuePages colors, normals;
};

/// Compares all cells of all levels.
void expect_equal_cells(const std::string& bytes) {
  const AlignedBytes aligned(bytes);
  const VdagContents contents = parse_vdag(aligned.span());
  const HeaderScene header(bytes);
  ASSERT_TRUE(header.is_open()) << header.error();
  EXPECT_EQ(header.scene().info.has_colors != 0, contents.attributes.has_colors());
  EXPECT_EQ(header.scene().info.has_normals != 0, contents.attributes.has_normals());
  EXPECT_EQ(header.scene().info.has_materials != 0, contents.attributes.has_materials());
  for (int level = 0; level <= contents.view.levels; ++level)
    for (std::uint64_t code = 0; code < std::uint64_t{1} << 3 * level; ++code)
      ASSERT_EQ(cell_difference(contents, header.scene(), morton_decode(code), level), "");
  EXPECT_EQ(first_difference(contents, header.scene(), 3000, 2), "");
}

TEST(ReaderCells, HaveTheAttributesOfTheLibrary) {
  for (const int levels : {2, 3, 5})
    for (int finest = 0; finest <= levels; ++finest)
      for (int precision = 0; precision < 8; ++precision)
        expect_equal_cells(
            ColoredScene(levels, 40 * levels, finest, precision).bytes(true, true, true));
}

TEST(ReaderCells, MayHaveAnyOfTheAttributes) {
  const ColoredScene scene(6, 900, 6, 2);
  for (int kinds = 0; kinds < 8; ++kinds)
    expect_equal_cells(scene.bytes((kinds & 1) != 0, (kinds & 2) != 0, (kinds & 4) != 0));
}

TEST(ReaderCells, OfScenesWithoutVoxelsDoNotExist) {
  expect_equal_cells(ColoredScene(4, 0, 3, 0).bytes(true, true, true));
  expect_equal_cells(vdag_file_bytes(brute_svdag(2, {})));
}

TEST(ReaderCells, OutsideOfTheGridHaveNoVoxels) {
  const HeaderScene header(vdag_file_bytes(brute_svdag(3, all_voxels(3))));
  const std::int32_t n = 8, least = std::numeric_limits<std::int32_t>::min();
  for (const std::int32_t outside : {-1, n, least, 1 << 30})
    for (int axis = 0; axis < 3; ++axis) {
      std::int32_t voxel[3] = {1, 2, 3};
      EXPECT_EQ(voxdag_contains(&header.scene(), 3, voxel), 1);
      voxel[axis] = outside;
      EXPECT_EQ(voxdag_contains(&header.scene(), 3, voxel), 0);
    }
  const std::int32_t root[3] = {0, 0, 0};
  EXPECT_EQ(voxdag_contains(&header.scene(), -1, root), 0);
  EXPECT_EQ(voxdag_contains(&header.scene(), 4, root), 0);
}

TEST(ReaderPoints, LieInTheVoxelsOfTheLibrary) {
  const Grid grid = odd_grid(5);
  const Svdag dag = brute_svdag(5, random_voxels(5, 4000, 4));
  const HeaderScene header(file_in_grid(dag, grid));
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> at(-4, 36);
  const auto expect_equal = [&](Vec3d point) {
    const double xyz[3] = {point.x, point.y, point.z};
    std::int32_t voxel[3];
    voxdag_voxel_at(&header.scene(), xyz, voxel);
    const Vec3i expected = containing_voxel(grid, point);
    EXPECT_EQ((Vec3i{voxel[0], voxel[1], voxel[2]}), expected);
    EXPECT_EQ(voxdag_contains_point(&header.scene(), xyz) != 0,
              svdag_contains(dag.view(), expected, 5));
  };
  for (int i = 0; i < 20'000; ++i) expect_equal(grid.to_world({at(rng), at(rng), at(rng)}));
  for (int i = -40; i < 40; ++i) expect_equal(grid.to_world({i * 1.0, i * 0.5, i * 0.25}));
  for (const double far : {1e8, 7.94e7, 1e300, HUGE_VAL, std::nan("")})
    expect_equal({far, -far, 0});
}

TEST(ReaderWalks, MeetTheVoxelsOfWindowsInOrder) {
  std::mt19937 rng(3);
  for (int levels = 2; levels <= 6; ++levels) {
    const Svdag dag = brute_svdag(levels, random_voxels(levels, 400, 8));
    const HeaderScene header(vdag_file_bytes(dag));
    const auto coordinate = [&] {
      return static_cast<std::int32_t>(rng() % ((1u << levels) + 8)) - 4;
    };
    for (int i = 0; i < 300; ++i) {
      const std::int32_t lo[3] = {coordinate(), coordinate(), coordinate()};
      const std::int32_t hi[3] = {coordinate(), coordinate(), coordinate()};
      std::vector<Vec3i> expected, found;
      for_each_voxel(dag.view(), {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}},
                     [&](Vec3i voxel) { expected.push_back(voxel); });
      voxdag_walk walk;
      voxdag_walk_begin(&walk, &header.scene(), lo, hi);
      for (Vec3i voxel; next_voxel(walk, voxel);) found.push_back(voxel);
      ASSERT_EQ(found, expected);
    }
  }
}

TEST(ReaderWalks, MayGoFromBlockToBlock) {
  const Svdag dag = brute_svdag(6, random_voxels(6, 2000, 8));
  const HeaderScene header(vdag_file_bytes(dag));
  const std::int32_t lo[3] = {3, 0, 9}, hi[3] = {60, 41, 64};
  voxdag_walk walk;
  voxdag_walk_begin(&walk, &header.scene(), lo, hi);
  for_each_leaf_block(dag.view(), {{3, 0, 9}, {60, 41, 64}}, [&](Vec3i block, std::uint64_t mask) {
    Vec3i voxel;
    ASSERT_TRUE(next_voxel(walk, voxel));
    EXPECT_EQ((Vec3i{walk.block[0], walk.block[1], walk.block[2]}), block);
    EXPECT_EQ(walk.left, mask & (mask - 1));
    walk.left = 0;
  });
  Vec3i voxel;
  EXPECT_FALSE(next_voxel(walk, voxel));
}

TEST(ReaderWalks, OfFullAndEmptyScenes) {
  const HeaderScene full(vdag_file_bytes(brute_svdag(4, all_voxels(4))));
  const HeaderScene empty(vdag_file_bytes(brute_svdag(4, {})));
  const std::int32_t lo[3] = {-100, -100, -100}, hi[3] = {100, 100, 100};
  voxdag_walk walk;
  Vec3i voxel;
  voxdag_walk_begin(&walk, &full.scene(), lo, hi);
  for (const Vec3i expected : all_voxels(4)) {
    ASSERT_TRUE(next_voxel(walk, voxel));
    EXPECT_EQ(voxel, expected);
  }
  EXPECT_FALSE(next_voxel(walk, voxel));
  voxdag_walk_begin(&walk, &empty.scene(), lo, hi);
  EXPECT_FALSE(next_voxel(walk, voxel));
}

TEST(ReaderScenes, MayBeCopied) {
  const HeaderScene header(vdag_file_bytes(brute_svdag(3, {{1, 2, 3}})));
  const voxdag_scene copy = header.scene();
  const std::int32_t voxel[3] = {1, 2, 3};
  EXPECT_EQ(voxdag_contains(&copy, 3, voxel), 1);
}

}  // namespace
}  // namespace voxdag
