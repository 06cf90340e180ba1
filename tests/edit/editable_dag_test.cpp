#include "voxdag/edit/editable_dag.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace voxdag
