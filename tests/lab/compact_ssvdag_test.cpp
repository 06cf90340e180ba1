#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "lab/compact/merged_dag.hpp"
#include "lab/compact/plain_sizes.hpp"
#include "lab/compact/ssvdag.hpp"
#include "lab/compact/symmetry.hpp"
#include "support/brute_svdag.hpp"

namespace voxdag::lab {
namespace {

using Voxels = std::vector<Vec3i>;

Voxels sorted(Voxels voxels) {
  std::sort(voxels.begin(), voxels.end(), [](Vec3i a, Vec3i b) {
    return std::array{a.x, a.y, a.z} < std::array{b.x, b.y, b.z};
  });
  voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
  return voxels;
}

Voxels image_of(int symmetry, const Voxels& voxels, int size) {
  Voxels image;
  for (const Vec3i voxel : voxels) image.push_back(image_of_voxel(symmetry, voxel, size));
  return sorted(image);
}

Voxels voxels_of_block(std::uint64_t block) {
  Voxels voxels;
  for (int i = 0; i < 64; ++i)
    if (((block >> i) & 1) != 0) voxels.push_back(morton_decode(static_cast<unsigned>(i)));
  return voxels;
}

/// Returns the voxels of a node from those of its children, which children(octant) returns.
template <class Children>
Voxels joined(int half, const Children& children) {
  Voxels voxels;
  for (int octant = 0; octant < 8; ++octant)
    for (const Vec3i voxel : children(octant))
      voxels.push_back(voxel +
                       Vec3i{(octant & 1) * half, (octant >> 1 & 1) * half, (octant >> 2) * half});
  return sorted(voxels);
}

Voxels decode(const MergedDag& dag, std::size_t level, std::uint32_t node) {
  if (level == dag.nodes.size()) return sorted(voxels_of_block(dag.leaf_blocks[node]));
  const int half = 2 << (dag.nodes.size() - level);
  return joined(half, [&](int octant) {
    const MergedChild child = dag.nodes[level][node][octant];
    if (child.node == kNoNode) return Voxels();
    return image_of(child.symmetry, decode(dag, level + 1, child.node), half);
  });
}

Voxels decode(const DagNodes& dag, std::size_t level, std::uint32_t node) {
  if (level == dag.nodes.size()) return sorted(voxels_of_block(dag.leaf_blocks[node]));
  return joined(2 << (dag.nodes.size() - level), [&](int octant) {
    const std::uint32_t child = dag.nodes[level][node][octant];
    return child == kNoNode ? Voxels() : decode(dag, level + 1, child);
  });
}

/// Returns the number of nodes of the level of which none is the image of another.
std::size_t brute_count(const DagNodes& dag, std::size_t level, int symmetries) {
  std::set<std::vector<std::array<int, 3>>> classes;
  const std::size_t nodes =
      level == dag.nodes.size() ? dag.leaf_blocks.size() : dag.nodes[level].size();
  for (std::uint32_t node = 0; node < nodes; ++node) {
    const Voxels voxels = decode(dag, level, node);
    std::vector<std::array<int, 3>> smallest;
    for (int s = 0; s < symmetries; ++s) {
      std::vector<std::array<int, 3>> image;
      for (const Vec3i v : image_of(s, voxels, 4 << (dag.nodes.size() - level)))
        image.push_back({v.x, v.y, v.z});
      if (s == 0 || image < smallest) smallest = image;
    }
    classes.insert(smallest);
  }
  return classes.size();
}

std::size_t count(const MergedDag& dag, std::size_t level) {
  return level == dag.nodes.size() ? dag.leaf_blocks.size() : dag.nodes[level].size();
}

MergedDag merge(int levels, const Voxels& voxels, MergeRule rule) {
  return merge_nodes(list_nodes(brute_svdag(levels, voxels).view()), rule, Progress());
}

/// Voxels among which many nodes are images of others: a random corner and its images.
Voxels symmetric_voxels(int levels, int count, unsigned seed) {
  const int half = 1 << (levels - 1);
  std::mt19937 random(seed);
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  Voxels corner, voxels;
  for (int i = 0; i < count; ++i) corner.push_back({below(half), below(half), below(half)});
  for (int octant = 0; octant < 8; ++octant) {
    const int symmetry = octant % 2 == 0 ? below(kSymmetries) : below(kMirrors);
    for (const Vec3i voxel : corner)
      voxels.push_back(image_of_voxel(symmetry, voxel, half) +
                       Vec3i{(octant & 1) * half, (octant >> 1 & 1) * half, (octant >> 2) * half});
  }
  return voxels;
}

TEST(CompactSymmetry, ImagesOfBlocksAreImagesOfTheirVoxels) {
  std::mt19937_64 random(1);
  for (int s = 0; s < kSymmetries; ++s) {
    const std::uint64_t block = random() & random();
    EXPECT_EQ(sorted(voxels_of_block(image_of_block(s, block))),
              image_of(s, voxels_of_block(block), 4));
  }
}

TEST(CompactSymmetry, ProductsAndInversesAreThoseOfImages) {
  const SymmetryGroup& group = symmetry_group();
  const Vec3i voxel{0, 1, 3};
  for (int s = 0; s < kSymmetries; ++s) {
    EXPECT_EQ(group.product[s][group.inverse[s]], 0);
    for (int t = 0; t < kSymmetries; ++t)
      EXPECT_EQ(image_of_voxel(group.product[s][t], voxel, 4),
                image_of_voxel(s, image_of_voxel(t, voxel, 4), 4));
  }
}

TEST(CompactMerge, KeepsEveryVoxel) {
  for (unsigned seed = 0; seed < 20; ++seed)
    for (const MergeRule rule :
         {MergeRule::kPublishedMirrors, MergeRule::kMirrors, MergeRule::kSymmetries}) {
      const int levels = 2 + static_cast<int>(seed % 4);
      for (const Voxels& voxels :
           {random_voxels(levels, 60, seed), symmetric_voxels(levels, 40, seed)})
        EXPECT_EQ(decode(merge(levels, voxels, rule), 0, 0), sorted(voxels));
    }
}

TEST(CompactMerge, EveryNodeIsTheImageThatItIsSaidToBe) {
  const DagNodes dag = list_nodes(brute_svdag(4, symmetric_voxels(4, 30, 5)).view());
  const MergedDag merged = merge_nodes(dag, MergeRule::kSymmetries, Progress());
  for (std::size_t level = 0; level < merged.image.size(); ++level)
    for (std::uint32_t node = 0; node < merged.image[level].size(); ++node) {
      const MergedChild image = merged.image[level][node];
      EXPECT_EQ(image_of(image.symmetry, decode(merged, level, image.node),
                         4 << (dag.nodes.size() - level)),
                decode(dag, level, node));
    }
}

TEST(CompactMerge, NoRepresentativeIsTheImageOfAnother) {
  for (unsigned seed = 0; seed < 12; ++seed)
    for (const Voxels& voxels : {random_voxels(4, 50, seed), symmetric_voxels(4, 30, seed)}) {
      const DagNodes dag = list_nodes(brute_svdag(4, voxels).view());
      const MergedDag mirrors = merge_nodes(dag, MergeRule::kMirrors, Progress());
      const MergedDag all = merge_nodes(dag, MergeRule::kSymmetries, Progress());
      for (std::size_t level = 0; level <= dag.nodes.size(); ++level) {
        EXPECT_EQ(count(mirrors, level), brute_count(dag, level, kMirrors));
        EXPECT_EQ(count(all, level), brute_count(dag, level, kSymmetries));
      }
    }
}

// A leaf that only the mirror of x and y together leaves alone: its mirrors of x and of y are
// equal, which the published comparison does not see.
TEST(CompactMerge, ThePublishedRuleMissesInvariancesOfTwoAxes) {
  const Voxels node{{0, 0, 0}, {3, 3, 0}, {4, 4, 4}, {5, 4, 4}, {4, 6, 4}, {7, 7, 7}};
  Voxels voxels = node;
  for (const Vec3i voxel : node) voxels.push_back(image_of_voxel(2, voxel, 8) + Vec3i{8, 8, 8});
  EXPECT_EQ(count(merge(4, voxels, MergeRule::kMirrors), 1), 1u);
  EXPECT_EQ(count(merge(4, voxels, MergeRule::kPublishedMirrors), 1), 2u);
}

TEST(CompactPlainSizes, ArePartsOfTheLayout) {
  const Svdag dag = brute_svdag(5, random_voxels(5, 200, 3));
  const SizeInParts size = svdag_size(dag.view());
  EXPECT_EQ(size.bytes(), dag.view().bytes());
  EXPECT_EQ(size.parts[2], (SizePart{"leaf blocks", 8 * dag.leaf_blocks.size()}));
  // One voxel of 8³: a node each of 8³, 4³ and 2³ voxels.
  EXPECT_EQ(svo_size(brute_svdag(3, {{0, 0, 0}}).view()).bytes(), 3u);
}

TEST(CompactSsvdag, SizesOfSmallGridsAreThoseByHand) {
  const auto bytes = [](int levels, const Voxels& voxels) {
    return ssvdag_size(brute_svdag(levels, voxels).view(), Progress()).bytes();
  };
  EXPECT_EQ(bytes(3, {}), 0u);
  EXPECT_EQ(bytes(2, {{1, 2, 3}}), 8u);                 // a leaf
  EXPECT_EQ(bytes(3, {{0, 0, 0}}), 2u + 2u + 8u + 4u);  // tags, pointer, leaf, start of level
  EXPECT_EQ(bytes(3, {{0, 0, 0}, {7, 7, 7}}), 2u + 4u + 8u + 4u);   // mirrors share a leaf
  EXPECT_EQ(bytes(3, {{1, 0, 0}, {0, 5, 0}}), 2u + 4u + 16u + 4u);  // permutations do not
}

TEST(CompactSsvdag, PlacesFrom8192OnTakeTwoWords) {
  MergedDag dag;
  dag.nodes.resize(2);
  dag.nodes[0].resize(1);
  dag.nodes[0][0][0] = {0, 0};
  for (std::uint32_t i = 0; i < 8193; ++i) {
    dag.leaf_blocks.push_back(i);
    dag.nodes[1].emplace_back()[0] = {i, 0};
  }
  const SizeInParts size = ssvdag_size(dag);
  EXPECT_EQ(size.parts[0], (SizePart{"tags", 2 * 8194}));
  EXPECT_EQ(size.parts[1], (SizePart{"16-bit pointers", 2 * 8193}));
  EXPECT_EQ(size.parts[2], (SizePart{"32-bit pointers", 4}));
  // The leaf of the most pointers comes first.
  dag.nodes[1].emplace_back()[0] = {8192, 0};
  EXPECT_EQ(ssvdag_size(dag).parts[2], (SizePart{"32-bit pointers", 4}));
  EXPECT_EQ(ssvdag_size(dag).parts[1], (SizePart{"16-bit pointers", 2 * 8194}));
}

}  // namespace
}  // namespace voxdag::lab
