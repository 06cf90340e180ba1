/// The commands that make one DAG from another: `voxdag crop`, `shift`, `mirror`, `rotate`,
/// `dilate`, `erode` and `fill`; `hollow` and `carve` have files of
/// their own.
#include <fmt/core.h>

#include <memory>
#include <stdexcept>
#include <utility>

#include "cli/commands.hpp"
#include "cli/parse.hpp"
#include "edit/edit_command.hpp"
#include "voxdag/algebra/components.hpp"
#include "voxdag/algebra/crop.hpp"
#include "voxdag/algebra/grow.hpp"
#include "voxdag/algebra/reorient.hpp"
#include "voxdag/algebra/shift.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag::cli {
namespace {

std::string text_of(Vec3i v) { return fmt::format("{},{},{}", v.x, v.y, v.z); }

Vec3i parse_offset(const std::string& text) {
  const Vec3d v = parse_vec3(text);
  Vec3i offset;
  for (int axis = 0; axis < 3; ++axis) {
    offset[axis] = static_cast<std::int32_t>(v[axis]);
    if (static_cast<double>(offset[axis]) != v[axis])
      throw std::invalid_argument("must be three whole numbers of voxels");
  }
  return offset;
}

void add_crop_command(const Command& program, Session& session) {
  const Command command =
      program.add("crop", "Keep the voxels of a DAG that lie in a box",
                  "voxdag crop scene.vdag --window 0,0,0,512,512,256 -o part.vdag\n\n"
                  "The grid stays as it is.");
  const auto box = std::make_shared<Box3i>();
  command
      .parsed("--window", *box, parse_window, "X0,Y0,Z0,X1,Y1,Z1",
              "The first voxel, and one past the last on each axis")
      .required();
  add_edit(
      command, session,
      [box](const SvdagView& dag, Placing&, const EditContext& context) {
        return crop(dag, *box, context.work);
      },
      [box] { return "cropped to " + text_of(box->lo) + "," + text_of(box->hi); },
      [box](const LongSvdagView& dag, const EditContext& context) {
        return crop(dag, *box, context.work);
      });
}

void add_shift_command(const Command& program, Session& session) {
  struct Arguments {
    Vec3i by;
    std::optional<int> levels;
    bool drop_outside = false;
  };
  const Command command = program.add("shift", "Move the voxels of a DAG in its grid",
                                      "voxdag shift scene.vdag --by 100,0,-20 -o moved.vdag");
  const auto arguments = std::make_shared<Arguments>();
  command.parsed("--by", arguments->by, parse_offset, "X,Y,Z", "How far to move, in whole voxels")
      .required();
  command.optional_number<int>("--levels", arguments->levels,
                               NumberRange::whole(kMinLevels, kMaxLevels), "L",
                               "Write a grid of 2^L voxels a side with the same lower corner "
                               "(default: that of FILE)");
  command.flag("--drop-outside", arguments->drop_outside,
               "Leave out voxels that leave the grid; without it, that is an error");
  add_edit(
      command, session,
      [arguments](const SvdagView& dag, Placing& placing, const EditContext& context) {
        const int levels = arguments->levels.value_or(dag.levels);
        placing.grid.levels = levels;
        placing.offset = arguments->by;
        Svdag moved = shift(dag, arguments->by, levels, context.work);
        if (arguments->drop_outside) return moved;
        const std::uint64_t lost = count_svdag(dag).voxels - count_svdag(moved.view()).voxels;
        if (lost != 0)
          throw Error(context.path, "",
                      fmt::format("{} voxels would leave the grid: --levels makes it larger, "
                                  "--drop-outside leaves them out",
                                  lost));
        return moved;
      },
      [arguments] { return "shifted by " + text_of(arguments->by); });
}

void add_mirror_command(const Command& program, Session& session) {
  const Command command = program.add("mirror", "Mirror a DAG in the middle of its grid",
                                      "voxdag mirror scene.vdag --axis x -o mirrored.vdag");
  const auto axis = std::make_shared<int>(0);
  command.parsed("--axis", *axis, parse_axis, "AXIS", "The axis that changes direction: x, y or z")
      .required();
  add_edit(
      command, session,
      [axis](const SvdagView& dag, Placing& placing, const EditContext& context) {
        placing.orientation = mirrored(*axis);
        return reorient(dag, placing.orientation, context.work);
      },
      [axis] { return fmt::format("mirrored along {}", "xyz"[*axis]); });
}

void add_rotate_command(const Command& program, Session& session) {
  struct Arguments {
    int axis = 0, turns = 1;
  };
  const Command command =
      program.add("rotate", "Rotate a DAG about the middle of its grid by quarter turns",
                  "voxdag rotate scene.vdag --axis z --turns 1 -o rotated.vdag");
  const auto arguments = std::make_shared<Arguments>();
  command
      .parsed("--axis", arguments->axis, parse_axis, "AXIS", "The axis to rotate about: x, y or z")
      .required();
  command.number("--turns", arguments->turns, NumberRange::whole(-3, 3), "N",
                 "Number of quarter turns; one about z takes x to y");
  add_edit(
      command, session,
      [arguments](const SvdagView& dag, Placing& placing, const EditContext& context) {
        placing.orientation = rotated(arguments->axis, arguments->turns);
        return reorient(dag, placing.orientation, context.work);
      },
      [arguments] {
        return fmt::format("rotated about {} by {} quarter turns", "xyz"[arguments->axis],
                           arguments -> turns);
      });
}

void add_grow_command(const Command& program, Session& session, bool is_dilation) {
  struct Arguments {
    int steps = 1;
    Neighbours neighbours = Neighbours::k26;
  };
  const Command command =
      is_dilation
          ? program.add("dilate", "Add the voxels that are near those of a DAG",
                        "voxdag dilate scene.vdag --steps 3 -o thick.vdag\n\n"
                        "The result also has all voxels that are --steps steps from voxel to "
                        "neighbour or less away.")
          : program.add("erode", "Remove the voxels of a DAG that are near empty places",
                        "voxdag erode solid.vdag --steps 3 -o thin.vdag\n\n"
                        "The result has the voxels that are more than --steps steps away "
                        "from every empty place. All places outside the grid are empty.");
  const auto arguments = std::make_shared<Arguments>();
  command.number("--steps", arguments->steps, NumberRange::whole(1, std::int64_t{1} << kMaxLevels),
                 "N", "Number of steps from voxel to neighbour");
  add_neighbours_option(command, arguments->neighbours);
  add_edit(
      command, session,
      [=](const SvdagView& dag, Placing&, const EditContext& context) {
        return is_dilation ? dilate(dag, arguments->steps, arguments->neighbours, context.work)
                           : erode(dag, arguments->steps, arguments->neighbours, context.work);
      },
      [=] {
        return fmt::format("{} by {} steps to {} neighbours", is_dilation ? "dilated" : "eroded",
                           arguments->steps, arguments->neighbours == Neighbours::k6 ? 6 : 26);
      },
      {}, is_dilation);
}

void add_fill_command(const Command& program, Session& session) {
  const Command command = program.add(
      "fill", "Fill the cavities that the voxels of a DAG enclose",
      "voxdag fill shell.vdag -o solid.vdag\n\n"
      "A cavity is a set of empty places that no way over faces connects with the sides of the "
      "grid.");
  add_edit(
      command, session,
      [](const SvdagView& dag, Placing&, const EditContext& context) {
        return fill_cavities(dag, context.work);
      },
      [] { return "filled"; }, {}, true);
}

}  // namespace

void add_edit_commands(const Command& program, Session& session) {
  add_crop_command(program, session);
  add_shift_command(program, session);
  add_mirror_command(program, session);
  add_rotate_command(program, session);
  add_grow_command(program, session, true);
  add_grow_command(program, session, false);
  add_fill_command(program, session);
  add_hollow_command(program, session);
  add_carve_command(program, session);
}

}  // namespace voxdag::cli
