/// `voxdag hollow`: makes a body hollow, for printing.
#include "voxdag/algebra/hollow.hpp"

#include <fmt/core.h>

#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "cli/length.hpp"
#include "cli/parse.hpp"
#include "edit/edit_command.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag::cli {
namespace {

struct DrainArgument {
  Vec3d at;
  Length radius;
};

DrainArgument parse_drain(const std::string& text) {
  const std::size_t comma = text.rfind(',');
  if (comma == text.npos) throw std::invalid_argument("must be X,Y,Z,RADIUS");
  return {parse_vec3(text.substr(0, comma)), parse_length(text.substr(comma + 1))};
}

struct HollowArguments {
  std::string wall_text;
  Length wall;
  std::vector<DrainArgument> drains;
};

Svdag hollowed(const HollowArguments& arguments, const SvdagView& dag, const Grid& grid,
               const EditContext& context) {
  const auto voxels = [&](const Length& length) {
    return in_scene_unit(length, context.unit, context.path) / grid.voxel_size;
  };
  std::vector<Drain> drains;
  for (const DrainArgument& drain : arguments.drains)
    drains.push_back({(drain.at - grid.origin) * (1 / grid.voxel_size), voxels(drain.radius)});
  const double wall = voxels(arguments.wall);
  if (wall < 1)
    throw Error(
        context.path, "",
        fmt::format("has voxels of {:g}, and the wall must have one at least: build it with "
                    "smaller ones",
                    grid.voxel_size));
  try {
    return hollow(dag, wall, drains, context.work);
  } catch (const OverMemory&) {
    throw;
  } catch (const Error& error) {
    const std::string reason = error.what();
    throw Error(context.path, "",
                reason.ends_with("than the wall")
                    ? reason +
                          ": it is thin or not solid; `voxdag fill` or build --solid makes it "
                          "solid"
                    : reason);
  }
}

}  // namespace

void add_hollow_command(const Command& program, Session& session) {
  const Command command = program.add(
      "hollow", "Remove the inside of a solid DAG, for printing",
      "voxdag hollow solid.vdag --wall 2mm -o hollow.vdag\n"
      "  voxdag hollow solid.vdag --wall 2mm --drain 10,0,3.5,1.5mm --drain 40,0,3.5,1.5mm -o "
      "hollow.vdag\n\n"
      "A voxel stays if the distance from its centre to the cube of the nearest empty place, also "
      "outside the grid, is at most --wall: flat walls have --wall rounded to whole voxels. "
      "`voxdag "
      "query --distances --signed` shows these distances.\n\n"
      "A drain is a round hole from X,Y,Z, on the surface, to the nearest voxel that was removed. "
      "Resin and powder need two, at different heights. A drain that does not open the cavity is "
      "an error.\n\n"
      "FILE must be solid: build it with --solid, or use `voxdag fill`.");
  const auto arguments = std::make_shared<HollowArguments>();
  command
      .parsed(
          "--wall", arguments->wall,
          [arguments = arguments.get()](const std::string& text) {
            arguments->wall_text = text;
            return parse_length(text);
          },
          "LENGTH",
          "Thickness of the wall: 2mm, 0.1in (units: mm, cm, m, in, ft), or a number in the unit "
          "of "
          "the coordinates")
      .required();
  command.repeated("--drain", arguments->drains, parse_drain, "X,Y,Z,RADIUS",
                   "Centre of a round hole on the surface, in the coordinates of FILE, and its "
                   "radius, a length as --wall. May be given several times");
  add_edit(
      command, session,
      [arguments](const SvdagView& dag, Placing& placing, const EditContext& context) {
        return hollowed(*arguments, dag, placing.grid, context);
      },
      [arguments] {
        return fmt::format("hollow with a wall of {} and {} drains", arguments->wall_text,
                           arguments->drains.size());
      });
}

}  // namespace voxdag::cli
