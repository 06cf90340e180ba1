#include "voxdag/edit/editable_dag.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "edit/edit_model.hpp"
#include "support/number_colors.hpp"
#include "voxdag/stored/svdag/svdag_lookup.hpp"

namespace voxdag {
namespace {

/// Changes both in the same random way. `has_colors`: checks and paints colours.
void edit_both(RandomEdits& random, EditableDag& dag, EditModel& model, bool has_colors) {
  const Value8 color = random.color();
  EditPaint paint;
  if (has_colors) paint.color = color;
  const EditShape shape = random.shape();
  switch (random.below(has_colors ? 9 : 8)) {
    case 0:
    case 1:
      dag.remove(shape);
      return model.remove(shape);
    case 2:
    case 3:
      dag.add(shape, paint);
      return model.add(shape, color);
    case 4: {
      const Box3i box = random.box();
      const Vec3i to = random.box().lo - Vec3i{3, 3, 3};
      const bool moves = random.below(2) != 0;
      dag.copy(box, to, moves);
      return model.copy(box, to, moves);
    }
    case 5:
    case 6: {
      const Box3i box = random.box();
      EditModel stamp(dag.levels(), random_voxels(dag.levels(), 200, random.below(1000)));
      const Svdag voxels = stamp.dag();
      const auto mode = static_cast<StampMode>(random.below(3));
      dag.stamp(voxels.view(), mode, {}, paint, box);
      model.for_each([&](Vec3i v) {
        bool in_box = mode == StampMode::kReplace;
        for (int axis = 0; axis < 3; ++axis)
          in_box &= v[axis] >= box.lo[axis] && v[axis] < box.hi[axis];
        if (in_box) model[v] = {};
        if (!stamp.has(v)) return;
        if (mode == StampMode::kRemove)
          model[v] = {};
        else if (!model.has(v))
          model[v] = {true, color};
      });
      return;
    }
    default: {
      if (has_colors) {
        const bool replaces = random.below(2) != 0;
        replaces ? dag.replace(shape, paint) : dag.paint(shape, paint);
        return replaces ? model.replace(shape, color) : model.paint(shape, color);
      }
      const BallShape ball = random.ball();
      const auto filter = static_cast<BallFilter>(random.below(3));
      dag.filter(ball, filter);
      return model.filter(ball, filter);
    }
  }
}

TEST(EditableDag, IsTheDagOfTheEditedVoxels) {
  for (const int levels : {2, 3, 5}) {
    for (unsigned seed = 0; seed < 6; ++seed) {
      RandomEdits random(levels, seed);
      const std::vector<Vec3i> voxels =
          seed == 0 ? std::vector<Vec3i>{} : random_voxels(levels, 4u << levels, seed);
      const Svdag base = brute_svdag(levels, voxels);
      EditableDag dag(base.view());
      std::vector<EditModel> models(1, EditModel(levels, voxels));
      std::size_t now = 0;
      for (int i = 0; i < 40; ++i) {
        const int step = random.below(5);
        if (step == 0 && now > 0) {
          ASSERT_TRUE(dag.undo());
          --now;
        } else if (step == 1 && now + 1 < models.size()) {
          ASSERT_TRUE(dag.redo());
          ++now;
        } else {
          models.resize(now + 1, models[0]);
          models.push_back(models[now]);
          edit_both(random, dag, models[++now], false);
        }
        ASSERT_EQ(dag.snapshot().svdag(), models[now].dag())
            << "levels " << levels << ", seed " << seed << ", step " << i;
        if (random.below(4) == 0) dag.collect();
      }
      while (dag.undo()) {
      }
      EXPECT_EQ(dag.snapshot().svdag(), base);
      while (dag.redo()) {
      }
      EXPECT_EQ(dag.snapshot().svdag(), models.back().dag());
    }
  }
}

TEST(EditableDag, KeepsColorsOfVoxelsAndGivesNewOnesTheirs) {
  const int levels = 4;
  for (unsigned seed = 0; seed < 8; ++seed) {
    RandomEdits random(levels, seed);
    const std::vector<Vec3i> voxels = random_voxels(levels, 300, seed + 1);
    const Svdag base = brute_svdag(levels, voxels);
    const NumberColors colors(base.view(), levels);
    EditableDag dag(colors.view());
    EditModel model(levels, voxels);
    for (const Vec3i v : voxels) {
      std::uint64_t number = 0;
      ASSERT_TRUE(find_number(colors.view(), v, levels, number));
      model[v].color = color_of_number(number);
    }
    for (int i = 0; i < 40; ++i) {
      edit_both(random, dag, model, true);
      const EditSnapshot snapshot = dag.snapshot();
      LookReader reader(snapshot.values());
      model.for_each([&](Vec3i v) {
        ASSERT_EQ(svdag_contains(snapshot.view(), v, levels), model.has(v));
        if (!model.has(v)) return;
        ASSERT_EQ(reader.read(v, levels).color, model[v].color)
            << v.x << " " << v.y << " " << v.z << ", seed " << seed << ", step " << i;
      });
      if (random.below(4) == 0) dag.collect();
    }
  }
}

TEST(EditableDag, SavesTheValuesThatVoxelsHave) {
  for (const int finest : {4, 3, 2, 1}) {
    RandomEdits random(4, static_cast<unsigned>(finest));
    const Svdag base = brute_svdag(4, random_voxels(4, 400, 5));
    const NumberColors colors(base.view(), finest);
    EditableDag dag(colors.view());
    EditModel model(4, {});
    for (int i = 0; i < 12; ++i) {
      edit_both(random, dag, model, true);
      const EditSnapshot snapshot = dag.snapshot();
      const Svdag saved = snapshot.svdag();
      const DagAttributes attributes = snapshot.attributes(saved.view());
      const ColoredDagView view{saved.view(), attributes.view()};
      if (saved.view().is_empty()) continue;
      LookReader live(snapshot.values()), stored(view);
      model.for_each([&](Vec3i v) {
        if (!svdag_contains(saved.view(), v, 4)) return;
        const VoxelLook a = live.read(v, 4), b = stored.read(v, 4);
        ASSERT_EQ(a.color, b.color) << "finest level " << finest << ", edit " << i;
        ASSERT_EQ(a.material, b.material);
        ASSERT_EQ(pack_normal(a.normal), pack_normal(b.normal));
      });
      if (i % 3 == 0) dag.undo();
    }
    // Without edits, all cells keep their values.
    while (dag.undo()) {
    }
    const DagAttributes same = dag.snapshot().attributes(base.view());
    LookReader before(colors.view()), after(ColoredDagView{base.view(), same.view()});
    for (int level = 0; level <= finest; ++level)
      for (int i = 0; i < 1 << (3 * level); ++i) {
        const Vec3i cell = morton_decode(static_cast<std::uint64_t>(i));
        ASSERT_EQ(before.read(cell, level).color, after.read(cell, level).color);
      }
  }
}

TEST(EditableDag, TakesTheColorOfTheNearestVoxelIfNoneIsGiven) {
  const std::vector<Vec3i> voxels{{0, 0, 0}, {15, 15, 15}};
  const Svdag base = brute_svdag(4, voxels);
  const NumberColors colors(base.view(), 4);
  EditableDag dag(colors.view());
  const Grid grid{.levels = 4};
  dag.add(make_ball(grid, {12, 12, 12}, 2));
  LookReader reader(dag.snapshot().values());
  EXPECT_EQ(reader.read({12, 12, 12}, 4).color, reader.read({15, 15, 15}, 4).color);
  EXPECT_NE(reader.read({12, 12, 12}, 4).color, reader.read({0, 0, 0}, 4).color);
}

TEST(EditableDag, PaintsCellsOfWhichTheShapeHasAVoxel) {
  for (const int finest : {1, 2, 3}) {
    const Svdag base = brute_svdag(4, random_voxels(4, 500, 3));
    const NumberColors colors(base.view(), finest);
    EditableDag dag(colors.view());
    const EditShape shape = make_ball({.levels = 4}, {7, 8, 6}, 3.3);
    const Value8 red{255, 0, 0};
    dag.paint(shape, {.color = red});
    LookReader before(colors.view()), after(dag.snapshot().values());
    const EditModel model(4, random_voxels(4, 500, 3));
    model.for_each([&](Vec3i v) {
      if (!model.has(v)) return;
      const int bits = 4 - finest;
      bool is_painted = false;
      model.for_each([&](Vec3i other) {
        const bool same_cell = v.x >> bits == other.x >> bits && v.y >> bits == other.y >> bits &&
                               v.z >> bits == other.z >> bits;
        is_painted |= same_cell && model.has(other) && oracle_has(shape, other);
      });
      ASSERT_EQ(after.read(v, 4).color, is_painted ? red : before.read(v, 4).color);
    });
  }
}

TEST(EditableDag, ReplacesAsAddingAndPaintingInOneEdit) {
  const EditPaint paints[] = {
      {.color = Value8{1, 2, 3}}, {.material = 2}, {.color = Value8{4, 5, 6}, .material = 3}};
  for (const int finest : {2, 4}) {
    const Svdag base = brute_svdag(4, random_voxels(4, 300, 3));
    const NumberColors colors(base.view(), finest);
    EditableDag dag(colors.view()), two(colors.view());
    RandomEdits random(4, 3);
    for (int i = 0; i < 12; ++i) {
      const EditShape shape = random.shape();
      const EditPaint& paint = paints[i % 3];
      dag.replace(shape, paint);
      two.add(shape, paint);
      two.paint(shape, paint);
      const EditSnapshot now = dag.snapshot(), other = two.snapshot();
      ASSERT_EQ(now.svdag(), other.svdag());
      LookReader a(now.values()), b(other.values());
      EditModel(4, {}).for_each([&](Vec3i v) {
        const bool is_set = svdag_contains(now.view(), v, 4), is_inside = oracle_has(shape, v);
        ASSERT_TRUE(is_set || !is_inside);
        if (!is_set) return;
        const VoxelLook is = a.read(v, 4), expected = b.read(v, 4);
        ASSERT_EQ(is.color, expected.color);
        ASSERT_EQ(is.material, expected.material);
        ASSERT_EQ(pack_normal(is.normal), pack_normal(expected.normal));
        if (!is_inside) return;
        ASSERT_EQ(is.color, paint.color.value_or(is.color));
        ASSERT_EQ(is.material, paint.material.value_or(is.material));
      });
    }
    EXPECT_EQ(dag.undo_count(), 12u);
    EXPECT_THROW(dag.replace(random.shape(), {.material = kNumberMaterials}), Error);
    while (dag.undo()) {
    }
    EXPECT_EQ(dag.snapshot().svdag(), base);
  }
}

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

TEST(EditableDag, MakesMinimalDagsOfBasesThatAreNot) {
  const std::vector<Vec3i> voxels = random_voxels(4, 300, 1);
  const Svdag minimal = brute_svdag(4, voxels);
  // The last pointer of the nodes of level 1 points to a second copy of its leaf block.
  Svdag base = minimal;
  base.leaf_blocks.push_back(base.leaf_blocks[base.nodes.back()]);
  base.nodes.back() = static_cast<std::uint32_t>(base.leaf_blocks.size() - 1);
  ASSERT_FALSE(EditNodes(base.view(), {}).is_minimal());
  ASSERT_TRUE(EditNodes(minimal.view(), {}).is_minimal());
  EditableDag dag(base.view());
  EditModel model(4, voxels);
  EXPECT_EQ(dag.snapshot().svdag(), minimal);
  RandomEdits random(4, 1);
  edit_both(random, dag, model, false);
  EXPECT_EQ(dag.snapshot().svdag(), model.dag());
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

TEST(EditShapes, RefuseWhatIsNoShape) {
  const Grid grid{.levels = 4};
  EXPECT_THROW(make_ball(grid, {0, 0, 0}, -1), Error);
  EXPECT_THROW(make_ball(grid, {0, 0, HUGE_VAL}, 1), Error);
  EXPECT_THROW(make_ball(grid, {1e9, 0, 0}, 1), Error);
  EXPECT_THROW(make_capsule(grid, {0, 0, 0}, {0, 0, NAN}, 1), Error);
  EXPECT_THROW(make_half_space(grid, {0, 0, 0}, {0, 0, 0}), Error);
}

TEST(EditShapes, PlaceCellsAsTheirVoxelsAre) {
  RandomEdits random(6, 9);
  for (int i = 0; i < 3000; ++i) {
    const EditShape shape = random.shape();
    const int bits = random.below(4);
    const int cells = 64 >> bits;
    const Vec3i origin =
        Vec3i{random.below(cells), random.below(cells), random.below(cells)} * (1 << bits);
    int inside = 0;
    const int side = 1 << bits;
    for (int v = 0; v < side * side * side; ++v)
      inside +=
          oracle_has(shape, origin + Vec3i{v % side, v / side % side, v / side / side}) ? 1 : 0;
    const CellPlace place =
        std::visit([&](const auto& of) { return of.place(origin, bits); }, shape);
    if (place == CellPlace::kInside) {
      ASSERT_EQ(inside, side * side * side);
    }
    if (place == CellPlace::kOutside) {
      ASSERT_EQ(inside, 0);
    }
    if (bits != 2) continue;
    const std::uint64_t block = std::visit([&](const auto& of) { return of.block(origin); }, shape);
    for (int v = 0; v < 64; ++v)
      ASSERT_EQ((block >> v & 1) != 0,
                oracle_has(shape, origin + morton_decode(static_cast<std::uint64_t>(v))));
  }
}

}  // namespace
}  // namespace voxdag
