/// The nodes that edits write: shared ones, memory, snapshots and changes.
#include <gtest/gtest.h>

#include <thread>

#include "edit/edit_model.hpp"
#include "support/number_colors.hpp"
#include "voxdag/edit/editable_dag.hpp"
#include "voxdag/stored/svdag/svdag_lookup.hpp"

namespace voxdag {
namespace {

TEST(EditableDag, AddsNoNodeThatItHas) {
  const Svdag base = brute_svdag(6, random_voxels(6, 3000, 1));
  EditableDag dag(base.view());
  const EditShape shape = make_ball({.levels = 6}, {30, 31, 33}, 12);
  dag.add(shape);
  const std::uint64_t nodes = dag.nodes().added_nodes();
  ASSERT_TRUE(dag.undo());
  dag.add(shape);
  dag.remove(make_half_space({.levels = 6}, {64, 0, 0}, {1, 0, 0}));
  EXPECT_EQ(dag.nodes().added_nodes(), nodes);
  EXPECT_TRUE(dag.snapshot().view().is_empty());
}

TEST(EditableDag, StaysBoundedWithALimitedHistory) {
  const Svdag base = brute_svdag(8, random_voxels(8, 20000, 1));
  EditableDag dag(base.view(), {.history = 10});
  RandomEdits random(8, 1);
  std::uint64_t most = 0;
  for (int i = 0; i < 3000; ++i) {
    const EditShape ball = make_ball(random.grid, random.point(), 8);
    random.below(2) == 0 ? dag.add(ball) : dag.remove(ball);
    if (i % 100 == 99) dag.collect();
    if (i == 300) most = dag.nodes().added_bytes();
  }
  EXPECT_EQ(dag.undo_count(), 10u);
  EXPECT_LT(dag.nodes().added_bytes(), 8 * most);
  const Svdag after = dag.snapshot().svdag();
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(dag.undo());
  EXPECT_FALSE(dag.undo());
  while (dag.redo()) {
  }
  EXPECT_EQ(dag.snapshot().svdag(), after);
}

TEST(EditableDag, UsesFreedMemoryInParts) {
  const Svdag base = brute_svdag(7, random_voxels(7, 10, 1));
  EditableDag dag(base.view(), {.history = 1}), other(base.view());
  RandomEdits random(7, 1);
  for (int i = 0; i < 300; ++i) {
    const EditShape shape = random.shape();
    const bool adds = random.below(2) == 0;
    for (EditableDag* of : {&dag, &other}) adds ? of->add(shape) : of->remove(shape);
    if (i % 3 == 0) dag.collect();
    ASSERT_EQ(dag.snapshot().svdag(), other.snapshot().svdag()) << i;
  }
}

TEST(EditableDag, KeepsSnapshotsWhileOthersEdit) {
  const Svdag base = brute_svdag(6, random_voxels(6, 5000, 1));
  const NumberColors colors(base.view(), 6);
  EditableDag dag(colors.view(), {.history = 2});
  RandomEdits random(6, 1);
  dag.remove(random.shape());
  dag.add(random.ball(), {.color = Value8{1, 2, 3}});
  const EditSnapshot snapshot = dag.snapshot();
  const Svdag expected = snapshot.svdag();
  std::thread reader([&] {
    for (int i = 0; i < 20; ++i) EXPECT_EQ(snapshot.svdag(), expected);
  });
  for (int i = 0; i < 200; ++i) {
    const EditShape ball = random.ball();
    random.below(2) == 0 ? dag.add(ball, {.color = random.color()}) : dag.remove(ball);
    if (i % 10 == 0) dag.collect();
  }
  reader.join();
  EXPECT_EQ(snapshot.svdag(), expected);
}

TEST(EditableDag, KeepsAMemoryLimitAndChangesNothingThen) {
  const Svdag base = brute_svdag(8, random_voxels(8, 20000, 1));
  MemoryBudget budget(24 << 20);
  EditableDag dag(base.view(), {}, &budget);
  RandomEdits random(8, 1);
  Svdag last = base;
  const auto edit_until_full = [&] {
    for (int i = 0; i < 100000; ++i) {
      last = i % 50 == 0 ? dag.snapshot().svdag() : last;
      dag.add(random.ball());
      dag.remove(random.ball());
    }
  };
  EXPECT_THROW(edit_until_full(), OverMemory);
  EXPECT_LE(budget.peak(), budget.limit());
  EXPECT_GT(dag.undo_count(), 0u);
  while (dag.undo()) {
  }
  EXPECT_EQ(dag.snapshot().svdag(), base);
}

TEST(EditableDag, TellsWhatWasWritten) {
  const Svdag base = brute_svdag(6, random_voxels(6, 3000, 1));
  EditableDag dag(base.view(), {.history = 1, .tracks_changes = true});
  std::vector<std::uint32_t> words = base.nodes;
  std::vector<std::uint64_t> blocks = base.leaf_blocks;
  RandomEdits random(6, 2);
  for (int i = 0; i < 50; ++i) {
    random.below(2) == 0 ? dag.add(random.shape()) : dag.remove(random.shape());
    if (i % 7 == 0) dag.collect();
    const SvdagView view = dag.snapshot().view();
    const EditChanges changes = dag.take_changes();
    words.resize(dag.nodes().words_end());
    blocks.resize(dag.nodes().blocks_end());
    for (const EditRun& run : changes.words)
      std::copy_n(view.nodes + run.first, run.count,
                  words.begin() + static_cast<std::ptrdiff_t>(run.first));
    for (const EditRun& run : changes.blocks)
      std::copy_n(view.leaf_blocks + run.first, run.count,
                  blocks.begin() + static_cast<std::ptrdiff_t>(run.first));
    SvdagView copy = view;
    copy.nodes = words.data();
    copy.leaf_blocks = blocks.data();
    for (int k = 0; k < 200; ++k) {
      const Vec3i v{random.below(64), random.below(64), random.below(64)};
      ASSERT_EQ(svdag_contains(copy, v, 6), svdag_contains(view, v, 6));
    }
  }
}

}  // namespace
}  // namespace voxdag
