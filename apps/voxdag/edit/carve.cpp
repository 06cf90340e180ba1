/// `voxdag carve`: keeps what surrounds the space that a capsule can reach.
#include "voxdag/algebra/carve.hpp"

#include <fmt/core.h>

#include <memory>
#include <stdexcept>

#include "cli/length.hpp"
#include "cli/parse.hpp"
#include "edit/edit_command.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag::cli {
namespace {

struct CapsuleSize {
  Length height, radius;
};

CapsuleSize parse_capsule(const std::string& text) {
  const std::size_t comma = text.find(',');
  if (comma == text.npos) throw std::invalid_argument("must be HEIGHT,RADIUS");
  return {parse_length(text.substr(0, comma)), parse_length(text.substr(comma + 1))};
}

struct CarveArguments {
  Vec3d from;
  std::string capsule_text;
  CapsuleSize capsule;
  std::optional<int> up;
  bool is_solid = false;
};

Svdag carved(const CarveArguments& arguments, const SvdagView& dag, const Grid& grid,
             const EditContext& context) {
  const int up = arguments.up.value_or(context.up ? *context.up - 'x' : 1);
  const auto in_world = [&](const Length& length) {
    return in_scene_unit(length, context.unit, context.path);
  };
  const Vec3i half = half_of_capsule(in_world(arguments.capsule.height),
                                     in_world(arguments.capsule.radius), up, grid.voxel_size);
  try {
    return carve(dag, voxel_at(grid, arguments.from), half,
                 arguments.is_solid ? CarveForm::kSolid : CarveForm::kWall, context.work);
  } catch (const OverMemory&) {
    throw;
  } catch (const Error& error) {
    throw Error(context.path, "", error.reason());
  }
}

}  // namespace

void add_carve_command(const Command& program, Session& session) {
  const Command command = program.add(
      "carve", "Keep the walls of the space that a capsule can reach",
      "voxdag carve scan.vdag --from 0,1.5,0 --capsule 1.6,0.3 -o walls.vdag\n\n"
      "The capsule stands upright with its middle at X,Y,Z and moves from voxel to voxel over "
      "faces, within the box of all voxels. It takes the voxels up to HEIGHT / 2 above and below "
      "its middle and up to RADIUS along the other axes, both rounded up to whole voxels: a box. "
      "The result has no voxel where it can be, and a wall of one voxel around.\n\n"
      "docs/splats.md shows the way from a scan to a collision file.");
  const auto arguments = std::make_shared<CarveArguments>();
  command
      .parsed("--from", arguments->from, parse_vec3, "X,Y,Z",
              "Where the middle of the capsule begins, in world units")
      .required();
  command
      .parsed(
          "--capsule", arguments->capsule,
          [arguments = arguments.get()](const std::string& text) {
            arguments->capsule_text = text;
            return parse_capsule(text);
          },
          "HEIGHT,RADIUS", "Size of the capsule: lengths in the unit of the scene, or 1.6m,30cm")
      .required();
  command.parsed("--up", arguments->up, parse_axis, "AXIS",
                 "The axis of the capsule: x, y or z (default: the one that FILE says is up, else "
                 "y)");
  command.flag("--solid", arguments->is_solid,
               "Fill the box of the space, and one voxel more on each side, instead of making a "
               "wall");
  add_edit(
      command, session,
      [arguments](const SvdagView& dag, Placing& placing, const EditContext& context) {
        return carved(*arguments, dag, placing.grid, context);
      },
      [arguments] {
        return fmt::format("carved from {:g},{:g},{:g} by a capsule of {}", arguments->from.x,
                           arguments->from.y, arguments->from.z, arguments->capsule_text);
      },
      {}, true);
}

}  // namespace voxdag::cli
