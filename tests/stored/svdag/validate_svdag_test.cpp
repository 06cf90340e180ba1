#include "voxdag/stored/svdag/validate_svdag.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "support/brute_svdag.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/morton.hpp"
#include "voxdag/stored/svdag/svdag_counts.hpp"

namespace voxdag {
namespace {

using Check = void (*)(const SvdagView&);

std::string fault(Check check, const Svdag& dag) {
  try {
    check(dag.view());
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Returns a DAG whose root has children 0 and 7. Both have one child, one of two leaf blocks.
Svdag two_corner_dag() { return brute_svdag(4, {{0, 0, 0}, {15, 15, 15}}); }

TEST(ValidateSvdag, AcceptsWhatTheReferenceBuilds) {
  for (int levels = 2; levels <= 8; ++levels)
    for (unsigned seed = 0; seed < 20; ++seed) {
      const Svdag dag = brute_svdag(levels, random_voxels(levels, 1 + 7 * seed, seed));
      EXPECT_EQ(fault(validate_svdag, dag), "");
      EXPECT_EQ(fault(check_canonical, dag), "");
      EXPECT_EQ(fault(check_minimal, dag), "");
    }
}

TEST(ValidateSvdag, AcceptsADagWithoutVoxels) {
  for (int levels = 2; levels <= 20; ++levels) {
    EXPECT_EQ(fault(validate_svdag, brute_svdag(levels, {})), "");
    EXPECT_EQ(fault(check_canonical, brute_svdag(levels, {})), "");
    EXPECT_EQ(fault(check_minimal, brute_svdag(levels, {})), "");
  }
}

TEST(ValidateSvdag, RefusesANodeWithoutChildren) {
  Svdag dag = two_corner_dag();
  dag.nodes[3] = 0;
  EXPECT_EQ(fault(validate_svdag, dag), "level 1, word 3: node has no children");
}

TEST(ValidateSvdag, RefusesAMaskOfMoreThanEightBits) {
  Svdag dag = two_corner_dag();
  dag.nodes[3] |= 0x100;
  EXPECT_EQ(fault(validate_svdag, dag), "level 1, word 3: child mask has more than eight bits");
}

TEST(ValidateSvdag, RefusesANodeThatLeavesItsLevel) {
  Svdag dag = two_corner_dag();
  dag.nodes[5] |= 1;
  EXPECT_EQ(fault(validate_svdag, dag), "level 1, word 5: node reaches past the end of its level");
}

TEST(ValidateSvdag, RefusesAPointerIntoTheMiddleOfANode) {
  Svdag dag = two_corner_dag();
  dag.nodes[1] = 4;
  EXPECT_EQ(fault(validate_svdag, dag),
            "level 0, word 1: pointer does not point to the first word of a node");
}

TEST(ValidateSvdag, RefusesAPointerToTheSameLevel) {
  Svdag dag = two_corner_dag();
  dag.nodes[1] = 0;
  EXPECT_EQ(fault(validate_svdag, dag), "level 0, word 1: pointer points outside the next level");
}

TEST(ValidateSvdag, RefusesAPointerPastTheWords) {
  Svdag dag = two_corner_dag();
  for (const std::uint32_t pointer : {7u, 8u, 0xFFFFFFFFu}) {
    dag.nodes[2] = pointer;
    EXPECT_EQ(fault(validate_svdag, dag), "level 0, word 2: pointer points outside the next level");
  }
}

TEST(ValidateSvdag, RefusesAPointerPastTheLeafBlocks) {
  Svdag dag = two_corner_dag();
  dag.nodes[6] = 2;
  EXPECT_EQ(fault(validate_svdag, dag), "level 1, word 6: pointer is past the last leaf block");
}

TEST(ValidateSvdag, RefusesALeafBlockWithoutVoxels) {
  Svdag dag = two_corner_dag();
  dag.leaf_blocks[1] = 0;
  EXPECT_EQ(fault(validate_svdag, dag), "leaf block 1: leaf block has no voxels");
}

TEST(ValidateSvdag, RefusesTwoRoots) {
  Svdag dag = brute_svdag(3, {{0, 0, 0}});
  dag.nodes.insert(dag.nodes.end(), {1u, 0u});
  for (int level = 1; level <= kMaxLevels; ++level) dag.level_begin[level] = 4;
  EXPECT_EQ(fault(validate_svdag, dag), "level 0, word 0: level 0 must be exactly one node");

  Svdag blocks = brute_svdag(2, {{0, 0, 0}});
  blocks.leaf_blocks.push_back(2);
  EXPECT_EQ(fault(validate_svdag, blocks), "level table: there is more than one root");
}

TEST(ValidateSvdag, RefusesABadLevelTable) {
  Svdag dag = two_corner_dag();
  dag.level_begin[0] = 1;
  EXPECT_EQ(fault(validate_svdag, dag), "level table: level 0 does not begin at word 0");
  dag = two_corner_dag();
  dag.level_begin[1] = 8;
  EXPECT_EQ(fault(validate_svdag, dag), "level table: level 1 ends before it begins");
  dag = two_corner_dag();
  dag.level_begin[1] = 7;
  EXPECT_EQ(fault(validate_svdag, dag), "level table: level 1 has no nodes");
  dag = two_corner_dag();
  dag.level_begin[5] = 8;
  EXPECT_EQ(fault(validate_svdag, dag), "level table: level 4 must have no node words");
  dag = two_corner_dag();
  dag.levels = 1;
  EXPECT_EQ(fault(validate_svdag, dag), "level table: 1 levels are not in the range 2 to 20");
  dag = two_corner_dag();
  dag.leaf_blocks.clear();
  EXPECT_EQ(fault(validate_svdag, dag), "level table: there are nodes, but no leaf blocks");
}

TEST(CheckCanonical, RefusesSwappedNodes) {
  Svdag dag = two_corner_dag();
  std::swap(dag.nodes[1], dag.nodes[2]);
  EXPECT_EQ(fault(validate_svdag, dag), "");
  EXPECT_EQ(fault(check_canonical, dag),
            "level 0, word 1: child is not the next in depth-first order");
}

TEST(CheckCanonical, RefusesNodesThatNothingPointsTo) {
  Svdag dag = two_corner_dag();
  dag.nodes[2] = dag.nodes[1];
  EXPECT_EQ(fault(validate_svdag, dag), "");
  EXPECT_EQ(fault(check_canonical, dag), "level 1, word 5: node has no parent");
  dag = two_corner_dag();
  dag.leaf_blocks.push_back(5);
  EXPECT_EQ(fault(check_canonical, dag), "leaf block 2: leaf block has no parent");
}

TEST(CheckMinimal, RefusesEqualNodes) {
  Svdag dag = two_corner_dag();
  dag.nodes[5] = dag.nodes[3];
  dag.nodes[6] = dag.nodes[4];
  EXPECT_EQ(fault(validate_svdag, dag), "");
  EXPECT_EQ(fault(check_minimal, dag), "level 1, word 5: node equals an earlier node of its level");
}

TEST(CheckMinimal, RefusesEqualLeafBlocks) {
  Svdag dag = two_corner_dag();
  dag.leaf_blocks[1] = dag.leaf_blocks[0];
  EXPECT_EQ(fault(check_minimal, dag), "leaf block 1: leaf block equals an earlier leaf block");
}

/// Changes each bit of a canonical minimal DAG. Either a check fails, or the words equal the
/// reference's DAG of the voxels that they now represent.
TEST(ValidateSvdag, EveryBitFlipIsFoundOrMakesAnotherCanonicalDag) {
  for (unsigned seed = 0; seed < 4; ++seed) {
    const Svdag original = brute_svdag(5, random_voxels(5, 12, seed));
    const std::size_t node_bits = original.nodes.size() * 32;
    int refused = 0;
    for (std::size_t bit = 0; bit < node_bits + original.leaf_blocks.size() * 64; ++bit) {
      Svdag dag = original;
      if (bit < node_bits)
        dag.nodes[bit / 32] ^= 1u << bit % 32;
      else
        dag.leaf_blocks[(bit - node_bits) / 64] ^= std::uint64_t{1} << (bit - node_bits) % 64;
      if (!fault(validate_svdag, dag).empty() || !fault(check_canonical, dag).empty() ||
          !fault(check_minimal, dag).empty()) {
        ++refused;
        continue;
      }
      std::vector<Vec3i> voxels;
      const std::function<void(int, std::uint64_t, Vec3i)> walk = [&](int level, std::uint64_t at,
                                                                      Vec3i cell) {
        for (int i = 0; i < 8; ++i) {
          const Vec3i child = cell * 2 + child_offset(i);
          if (level == 3) {
            for (int j = 0; j < 8; ++j)
              if (dag.leaf_blocks[at] >> (8 * i + j) & 1)
                voxels.push_back(child * 2 + child_offset(j));
          } else if (child_mask(&dag.nodes[at]) >> i & 1) {
            walk(level + 1, child_pointer(&dag.nodes[at], i), child);
          }
        }
      };
      walk(0, 0, {0, 0, 0});
      EXPECT_EQ(dag, brute_svdag(5, voxels)) << "bit " << bit;
    }
    EXPECT_GT(refused, static_cast<int>(node_bits) / 2);
  }
}

}  // namespace
}  // namespace voxdag
