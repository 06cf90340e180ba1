#include "voxdag/edit/edit_script.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "edit/edit_model.hpp"

namespace voxdag {
namespace {

/// 32³ voxels of side 1/2 with the corner at (10,20,30).
Grid test_grid() { return {.levels = 5, .origin = {10, 20, 30}, .voxel_size = 0.5}; }

EditStep step_of(std::string_view line) {
  const auto step = parse_edit_line(line, test_grid());
  EXPECT_TRUE(step) << line;
  return step.value_or(EditStep{});
}

std::string error_of(std::string_view line) {
  try {
    parse_edit_line(line, test_grid());
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// Returns the voxels after a script, started with a few voxels.
Svdag after(const std::vector<std::string>& lines) {
  const Svdag base = brute_svdag(5, random_voxels(5, 3000, 1));
  EditableDag dag(base.view());
  for (const std::string& line : lines)
    if (const auto step = parse_edit_line(line, test_grid())) apply_step(dag, *step);
  return dag.snapshot().svdag();
}

/// Returns the voxels after a change of the model that the script `after` began with.
template <class Change>
Svdag model_after(const Change& change) {
  EditModel model(5, random_voxels(5, 3000, 1));
  change(model);
  return model.dag();
}

TEST(EditScript, EachShapeHasTheVoxelsOfItsMakeFunction) {
  const Grid grid = test_grid();
  const double h = std::sqrt(0.5);
  const Vec3d axes[] = {{h, h, 0}, {-h, h, 0}, {0, 0, 1}};  // Turned about z by 45 degrees.
  const struct {
    std::string line;
    EditShape shape;
  } cases[] = {
      {"ball,18,28,38,3.3", make_ball(grid, {18, 28, 38}, 3.3)},
      {"box,12,22,32,20,24e0,45", make_box(grid, {12, 22, 32}, {20, 24, 45})},
      {"capsule,12,22,32,20,26,41,2", make_capsule(grid, {12, 22, 32}, {20, 26, 41}, 2)},
      {"halfspace,18,28,38,1,2,-3", make_half_space(grid, {18, 28, 38}, {1, 2, -3})},
      {"turnedbox,18,28,38,4,2,3,0,0,0.38268343236508977,0.92387953251128674",
       make_turned_box(grid, {18, 28, 38}, {4, 2, 3}, axes)},
  };
  for (const auto& of : cases) {
    EXPECT_EQ(after({"remove," + of.line}),
              model_after([&](EditModel& model) { model.remove(of.shape); }))
        << of.line;
    EXPECT_EQ(after({"add," + of.line}),
              model_after([&](EditModel& model) { model.add(of.shape, {}); }))
        << of.line;
  }
}

TEST(EditScript, FiltersCopiesAndMovesChangeWhatTheirVoxelsSay) {
  const auto ball = std::get<BallShape>(make_ball(test_grid(), {18, 28, 38}, 4));
  EXPECT_EQ(after({"smooth,ball,18,28,38,4"}),
            model_after([&](EditModel& model) { model.filter(ball, BallFilter::kSmooth); }));
  EXPECT_EQ(after({"grow,ball,18,28,38,4"}),
            model_after([&](EditModel& model) { model.filter(ball, BallFilter::kGrow); }));
  EXPECT_EQ(after({"shrink,ball,18,28,38,4"}),
            model_after([&](EditModel& model) { model.filter(ball, BallFilter::kShrink); }));
  // Voxel 4 begins at x = 12. The centre of voxel 9 is at x = 14.75.
  const Box3i box{{4, 4, 4}, {9, 10, 11}};
  for (const bool moves : {false, true})
    EXPECT_EQ(after({std::string(moves ? "move" : "copy") + ",12,22,32,14.75,25,35.5,17.1,22,30"}),
              model_after([&](EditModel& model) {
                model.copy(box, {14, 4, 0}, moves);
              }));
}

TEST(EditScript, UndoAndRedoChangeTheVersion) {
  const std::string ball = "remove,ball,18,28,38,4", box = "add,box,12,22,32,20,24,45";
  EXPECT_EQ(after({ball, box, "undo"}), after({ball}));
  EXPECT_EQ(after({ball, box, "undo", "undo", "redo"}), after({ball}));
  EXPECT_THROW(after({ball, "undo", "undo"}), Error);
  EXPECT_THROW(after({ball, "redo"}), Error);
}

TEST(EditScript, CommentsSpacesAndLineEndsDoNotCount) {
  for (const char* line : {"", "  ", "\r", "# remove,ball,1,2,3,4", "  # a comment\r"})
    EXPECT_FALSE(parse_edit_line(line, test_grid())) << line;
  const Svdag plain = after({"remove,ball,18,28,38,4"});
  EXPECT_EQ(after({"\xEF\xBB\xBF remove , ball,18, 28 ,38,\t4\r"}), plain);
}

TEST(EditScript, ColoursAndMaterialsFollowTheNumbers) {
  const EditStep both = step_of("paint,ball,1,2,3,4,material=7,#Ff8001");
  EXPECT_EQ(both.paint.color, (Value8{255, 128, 1}));
  EXPECT_EQ(both.paint.material, 7u);
  const EditStep replaced = step_of("replace,ball,1,2,3,4,#ff8001");
  EXPECT_EQ(replaced.verb, EditVerb::kReplace);
  EXPECT_EQ(replaced.paint.color, both.paint.color);
  EXPECT_FALSE(step_of("add,ball,1,2,3,4,material=7").paint.color);
  EXPECT_FALSE(step_of("add,ball,1,2,3,4").paint.material);
}

TEST(EditScript, AnErrorSaysWhatIsWrongAndWhatIsAllowed) {
  const struct {
    const char *line, *text;
  } cases[] = {
      {"carve,ball,1,2,3,4", "'carve' is no edit: use add, remove, paint, replace, smooth"},
      {"remove", "'' is no shape: use ball, box, capsule, halfspace or turnedbox"},
      {"remove,cube,1,2,3,4", "'cube' is no shape"},
      {"smooth,box,1,2,3,4,5,6", "smooth takes a ball only"},
      {"remove,ball,1,2,3", "ball needs 4 numbers: center 3, radius 1; it has 3"},
      {"copy,1,2,3", "copy needs 9 numbers: min 3, max 3, to 3; it has 3"},
      {"undo,1", "undo needs 0 numbers; it has 1"},
      {"remove,ball,1,2,3,x", "'x' is no number, no colour #rrggbb and no material=N"},
      {"remove,ball,1,2,3,nan", "'nan' is no number"},
      {"remove,ball,1,2,,4", "'' is no number"},
      {"remove,ball,1,2,3,4,", "the line ends in a comma"},
      {"undo,", "the line ends in a comma"},
      {"remove,ball,1,2,3,4,#ff0000", "remove takes no colour and no material"},
      {"paint,ball,1,2,3,4", "paint needs a colour #rrggbb or a material"},
      {"replace,ball,1,2,3,4", "replace needs a colour #rrggbb or a material"},
      {"paint,ball,1,2,3,4,#ff00", "'#ff00' is no colour: use #rrggbb"},
      {"paint,ball,1,2,3,4,#ff00gg", "'#ff00gg' is no colour"},
      {"paint,ball,1,2,3,4,#ff0000,#ff0000", "two colours"},
      {"paint,ball,1,2,3,4,material=-1", "'-1' is no number of a material"},
      {"paint,ball,1,2,3,#ff0000,4", "'4' follows the colour or material: numbers come first"},
      {"remove,ball,1,2,3,-4", "radius is negative"},
      {"remove,ball,1,2,1e300,4", "two million voxels"},
      {"copy,0,0,0,1,1,1,1e9,0,0", "two million voxels"},
      {"remove,box,1,2,3,0,4,5", "the box's max is less than its min"},
      {"remove,turnedbox,1,2,3,1,1,1,0,0,0,0", "the quaternion of the turn has no length"},
  };
  for (const auto& of : cases)
    EXPECT_NE(error_of(of.line).find(of.text), std::string::npos)
        << of.line << ": " << error_of(of.line);
}

TEST(EditScript, AtEditLineNamesTheLine) {
  try {
    at_edit_line(12, [] { return parse_edit_line("carve", test_grid()); });
    FAIL();
  } catch (const Error& error) {
    EXPECT_TRUE(std::string(error.what()).starts_with("line 12: 'carve' is no edit"));
  }
  EXPECT_THROW(at_edit_line(1, [] { throw Cancelled(); }), Cancelled);
}

}  // namespace
}  // namespace voxdag
