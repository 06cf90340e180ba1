// Compares the boxes beside a DAG's pointers with the voxels that they bound.
#include "voxdag/cpu/packets/bounded_dag.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/brute_svdag.hpp"
#include "support/voxel_sets.hpp"
#include "voxdag/core/morton.hpp"

namespace voxdag {
namespace {

/// Returns the box of the voxels in the cell of `level` at `cell`, in 32nds of that cell.
CellBox expected_box(const std::vector<Vec3i>& voxels, int levels, int level, Vec3i cell) {
  const int shift = levels - level;
  Vec3i first{31, 31, 31}, last{};
  for (const Vec3i& voxel : voxels)
    if (Vec3i{voxel.x >> shift, voxel.y >> shift, voxel.z >> shift} == cell)
      for (int axis = 0; axis < 3; ++axis) {
        const int at = voxel[axis] - (cell[axis] << shift);
        first[axis] = std::min(first[axis], at * 32 >> shift);
        last[axis] = std::max(last[axis], ((at + 1) * 32 - 1) >> shift);
      }
  CellBox box;
  for (int axis = 0; axis < 3; ++axis)
    box.bits |=
        static_cast<std::uint32_t>(first[axis] << (5 * axis) | last[axis] << (5 * axis + 15));
  return box;
}

/// Counts the pointers with a wrong box, in the subtree of the node at `cell`.
int wrong_boxes(const BoundedDag& dag, const std::vector<Vec3i>& voxels, std::uint32_t node,
                int level, Vec3i cell) {
  const int levels = dag.nodes().levels();
  if (level >= levels - 2) return 0;
  const std::uint32_t* words = dag.words() + 2 * std::size_t{node};
  const int children = popcount8(words[0]);
  int wrong = 0, at = 0;
  for (int i = 0; i < 8; ++i) {
    if ((words[0] >> i & 1u) == 0) continue;
    const Vec3i child = cell * 2 + child_offset(i);
    const std::uint32_t pointer = words[2 + at], box = words[2 + children + at];
    EXPECT_EQ(pointer, dag.nodes().child(node, level, i));
    wrong += box == expected_box(voxels, levels, level + 1, child).bits ? 0 : 1;
    wrong += wrong_boxes(dag, voxels, pointer, level + 1, child);
    ++at;
  }
  return wrong;
}

TEST(BoundedDag, BoxesBoundTheVoxels) {
  for (const int levels : {2, 3, 4, 5})
    for (const NamedVoxels& set : voxel_sets(levels, 5)) {
      if (set.voxels.empty()) continue;
      const Svdag dag = brute_svdag(levels, set.voxels);
      EXPECT_EQ(wrong_boxes(BoundedDag(SvdagNodes(dag.view())), set.voxels, 0, 0, {}), 0)
          << set.name << ", " << levels << " levels";
    }
}

}  // namespace
}  // namespace voxdag
