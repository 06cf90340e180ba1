#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "lab/compact/code_lengths.hpp"
#include "lab/compact/symmetry.hpp"
#include "lab/compact/transform_dag.hpp"
#include "lab/compact/translations.hpp"
#include "lab/compact/tsvdag.hpp"
#include "support/brute_svdag.hpp"
#include "voxdag/stored/svdag/svdag_lookup.hpp"

namespace voxdag::lab {
namespace {

/// Adds the voxels of a node to a dense grid of `size`³, x fastest.
std::vector<bool> decode(const TransformDag& dag, std::size_t level, std::uint32_t node) {
  const int size = 4 << (dag.nodes.size() - level), half = size / 2;
  const auto index = [](Vec3i v, int n) { return v.x + n * (v.y + n * v.z); };
  std::vector<bool> voxels(static_cast<std::size_t>(size) * size * size);
  if (level == dag.nodes.size()) {
    for (unsigned i = 0; i < 64; ++i)
      voxels[index(morton_decode(i), 4)] = ((dag.leaf_blocks[node] >> i) & 1) != 0;
    return voxels;
  }
  for (int octant = 0; octant < 8; ++octant) {
    const TransformedChild& child = dag.nodes[level][node][octant];
    if (child.node == kNoNode) continue;
    const std::vector<bool> source = decode(dag, level + 1, child.node);
    for (int i = 0; i < half * half * half; ++i) {
      if (!source[i]) continue;
      const Vec3i at = image_of_voxel(child.transform.symmetry,
                                      {i % half, i / half % half, i / half / half}, half) +
                       child.transform.move;
      if (std::min({at.x, at.y, at.z}) < 0 || std::max({at.x, at.y, at.z}) >= half) continue;
      voxels[index(at + Vec3i{(octant & 1) * half, (octant >> 1 & 1) * half, (octant >> 2) * half},
                   size)] = true;
    }
  }
  return voxels;
}

/// Random voxels in small boxes, so that many nodes have empty layers.
std::vector<Vec3i> boxed_voxels(int levels, int boxes, unsigned seed) {
  std::mt19937 random(seed);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  std::vector<Vec3i> voxels;
  for (int box = 0; box < boxes; ++box) {
    const int n = 1 << levels;
    const Vec3i lo{below(n), below(n), below(n)}, size{1 + below(5), 1 + below(5), 1 + below(3)};
    for (int z = lo.z; z < std::min(n, lo.z + size.z); ++z)
      for (int y = lo.y; y < std::min(n, lo.y + size.y); ++y)
        for (int x = lo.x; x < std::min(n, lo.x + size.x); ++x) voxels.push_back({x, y, z});
  }
  return voxels;
}

TEST(CompactTsvdag, KeepsEveryVoxel) {
  for (unsigned seed = 0; seed < 12; ++seed)
    for (const int move_height : {0, 2, 3, 4}) {
      const int levels = 2 + static_cast<int>(seed % 4);
      const Svdag dag = brute_svdag(
          levels, seed % 2 == 0 ? boxed_voxels(levels, 12, seed) : random_voxels(levels, 60, seed));
      const TransformDag merged =
          merge_transformed(list_nodes(dag.view()), move_height, Progress());
      const std::vector<bool> voxels = decode(merged, 0, 0);
      const int size = 1 << levels;
      for (int i = 0; i < size * size * size; ++i)
        ASSERT_EQ(voxels[i],
                  svdag_contains(dag.view(), {i % size, i / size % size, i / size / size}, levels))
            << seed << " " << move_height << " " << i;
    }
}

CubeGrid random_cube(int size, int voxels, std::mt19937& random) {
  CubeGrid cube;
  cube.size = size;
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  const Vec3i box{1 + below(size), 1 + below(size), 1 + below(size)};
  for (int i = 0; i < voxels; ++i) cube.set({below(box.x), below(box.y), below(box.z)});
  return cube;
}

bool is_image(const CubeGrid& a, const CubeGrid& b) {
  for (int s = 0; s < kSymmetries; ++s)
    if (image_of_grid(s, a) == b) return true;
  return false;
}

bool can_make(const CubeGrid& source, const CubeGrid& cube) {
  const int n = source.size;
  for (int s = 0; s < kSymmetries; ++s)
    for (int z = -n; z <= n; ++z)
      for (int y = -n; y <= n; ++y)
        for (int x = -n; x <= n; ++x)
          if (moved_grid(image_of_grid(s, source), {x, y, z}) == cube) return true;
  return false;
}

TEST(CompactTranslations, SourcesAreTheFirstThatCanMakeACube) {
  std::mt19937 random(7);
  for (const int size : {4, 8}) {
    std::vector<CubeGrid> cubes;
    while (cubes.size() < (size == 4 ? 24u : 8u)) {
      const CubeGrid cube = random_cube(size, 1 + static_cast<int>(random() % 4), random);
      if (std::none_of(cubes.begin(), cubes.end(),
                       [&](const CubeGrid& other) { return is_image(other, cube); }))
        cubes.push_back(cube);
    }
    std::vector<std::uint32_t> order(cubes.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
      return cubes[a].count() > cubes[b].count();
    });
    const std::vector<std::uint32_t> sources = find_sources(cubes, Progress());
    std::size_t moved = 0;
    for (std::size_t i = 0; i < cubes.size(); ++i) {
      const auto first = std::find_if(order.begin(), order.end(), [&](std::uint32_t source) {
        return can_make(cubes[source], cubes[i]);
      });
      EXPECT_EQ(sources[i], *first) << size << " " << i;
      if (sources[i] != i) ++moved;
      const Transform transform = first_transform(cubes[sources[i]], cubes[i]);
      EXPECT_EQ(moved_grid(image_of_grid(transform.symmetry, cubes[sources[i]]), transform.move),
                cubes[i]);
    }
    EXPECT_GT(moved, 1u);
  }
}

TEST(CompactTranslations, AMoveLosesTheVoxelsThatLeaveTheCube) {
  CubeGrid bar, voxel;
  for (int x = 0; x < 4; ++x) bar.set({x, 1, 2});
  voxel.set({3, 0, 0});
  EXPECT_EQ(find_sources({voxel, bar}, Progress()), (std::vector<std::uint32_t>{1, 1}));
  EXPECT_EQ(find_sources({bar}, Progress()), (std::vector<std::uint32_t>{0}));
}

/// Returns the least cost of a prefix code of at most `limit` bits, by trying all lengths.
std::uint64_t least_cost(const std::vector<std::uint64_t>& frequencies, int limit) {
  std::uint64_t least = std::numeric_limits<std::uint64_t>::max();
  std::function<void(std::size_t, int, std::uint64_t)> choose = [&](std::size_t i, int left,
                                                                    std::uint64_t cost) {
    if (i == frequencies.size()) least = std::min(least, cost);
    if (i == frequencies.size()) return;
    for (int bits = 1; bits <= limit; ++bits)
      if (const int used = 1 << (limit - bits); used <= left)
        choose(i + 1, left - used, cost + frequencies[i] * static_cast<std::uint64_t>(bits));
  };
  choose(0, 1 << limit, 0);
  return least;
}

TEST(CompactCode, LengthsAreOptimalAndWithinTheLimit) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 40; ++trial) {
    const int limit = 3 + trial % 2;
    std::vector<std::uint64_t> frequencies(2 + random() % 5);
    for (std::uint64_t& frequency : frequencies) frequency = random() % (trial % 3 == 0 ? 3 : 100);
    const std::vector<int> lengths = code_lengths(frequencies, limit);
    double kraft = 0;
    std::uint64_t cost = 0;
    for (std::size_t i = 0; i < lengths.size(); ++i) {
      EXPECT_GE(lengths[i], 1);
      EXPECT_LE(lengths[i], limit);
      kraft += std::ldexp(1.0, -lengths[i]);
      cost += frequencies[i] * static_cast<std::uint64_t>(lengths[i]);
    }
    EXPECT_LE(kraft, 1);
    EXPECT_EQ(cost, least_cost(frequencies, limit));
  }
}

TEST(CompactTsvdag, SizesOfSmallGridsAreThoseByHand) {
  const auto size = [](int levels, const std::vector<Vec3i>& voxels, int move_height) {
    return tsvdag_size(brute_svdag(levels, voxels).view(), move_height, Progress());
  };
  EXPECT_EQ(size(3, {}, 4).bytes(), 0u);
  EXPECT_EQ(size(2, {{1, 2, 3}}, 4).bytes(), 8u);
  // Tags, a pointer in place (never below two words), a leaf.
  EXPECT_EQ(size(3, {{0, 0, 0}}, 4).bytes(), 2u + 4u + 8u);
  // A single voxel is every other single voxel, moved.
  EXPECT_EQ(size(3, {{0, 0, 0}, {5, 2, 0}}, 4).bytes(), 2u + 8u + 8u);
  EXPECT_EQ(size(3, {{0, 0, 0}, {5, 2, 0}}, 0).bytes(), 2u + 8u + 16u);
  // Eight equal pointers: numbers of one word, and an entry of four words.
  std::vector<Vec3i> full;
  for (int i = 0; i < 512; ++i) full.push_back({i % 8, i / 8 % 8, i / 64});
  EXPECT_EQ(size(3, full, 4).bytes(), 2u + 16u + 8u + 8u);
  EXPECT_EQ(size(3, full, 4).parts[4], (SizePart{"pointer tables", 8}));
}

}  // namespace
}  // namespace voxdag::lab
