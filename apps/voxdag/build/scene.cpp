/// `voxdag scene`: procedural scenes as mesh files.
#include <fmt/core.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/human.hpp"
#include "cli/number_check.hpp"
#include "cli/parse.hpp"
#include "render/path_file.hpp"
#include "voxdag/scenes/ply_writer.hpp"
#include "voxdag/scenes/scenes.hpp"

namespace voxdag {
namespace {

struct SceneArguments {
  std::string name, output;
  SceneOptions options;
  bool list = false, view = false, path = false;
};

std::string option_text(const std::string& name, Vec3d v) {
  return fmt::format("{} {:.6g},{:.6g},{:.6g} ", name, v.x, v.y, v.z);
}

/// The options of `render` that show a scene well.
std::string view_options(const ScenePreset& preset) {
  return option_text("--eye", preset.eye) + option_text("--target", preset.target) +
         option_text("--up", preset.up) + option_text("--sun", preset.sun_direction) +
         fmt::format("--fov {:.6g}", preset.fov_degrees);
}

/// The flight through a scene as `render --path` reads it.
PathFile path_file(const ScenePreset& preset) {
  PathFile path;
  path.sun = preset.sun_direction;
  for (const SceneKey& key : preset.flight)
    path.keys.push_back({key.time, key.eye, key.target, {}, {}});
  path.keys.front().up = preset.up;
  path.keys.front().fov_degrees = preset.fov_degrees;
  return path;
}

void print_list(bool json) {
  if (json) {
    auto scenes = nlohmann::ordered_json::array();
    for (const SceneInfo& scene : scene_list())
      scenes.push_back({{"name", scene.name},
                        {"description", scene.description},
                        {"size", scene.size_meaning},
                        {"default_size", scene.default_size},
                        {"min_size", scene.min_size},
                        {"max_size", scene.max_size}});
    fmt::print("{}", json_text(scenes));
    return;
  }
  for (const SceneInfo& scene : scene_list())
    fmt::print("{:<11}{}\n{:<11}--size: {}, {} to {} (default {})\n", scene.name, scene.description,
               "", scene.size_meaning, scene.min_size, scene.max_size, scene.default_size);
}

void make(const SceneArguments& arguments, const Session& session) {
  const Progress& progress = session.progress;
  check_writable(arguments.output);
  const Mesh mesh = make_scene(arguments.name, arguments.options, &progress);
  write_ply(arguments.output, mesh, &progress);
  if (session.json) {
    const nlohmann::ordered_json summary = {{"file", arguments.output},
                                            {"vertices", mesh.vertices.size()},
                                            {"triangles", mesh.triangles.size()}};
    fmt::print("{}", json_text(summary));
  } else if (!session.quiet) {
    fmt::print("{}: {} triangles, {} vertices\n", arguments.output,
               with_commas(mesh.triangles.size()), with_commas(mesh.vertices.size()));
  }
}

}  // namespace

void add_scene_command(CLI::App& app, Session& session) {
  const auto arguments = std::make_shared<SceneArguments>();
  CLI::App& command = add_command(app, "scene", "Make a procedural scene as a PLY mesh",
                                  "voxdag scene courtyard -o courtyard.ply");
  command.add_option("name", arguments->name, "The scene; --list shows them")->type_name("NAME");
  CLI::Option* const output =
      command.add_option("-o,--output", arguments->output, "The mesh to write")
          ->type_name("FILE.ply");
  CLI::Option* const list =
      command.add_flag("--list", arguments->list, "List the scenes and what their size counts")
          ->excludes(output);
  CLI::Option* const view =
      command
          .add_flag("--view", arguments->view,
                    "Only print the options with which `voxdag render` shows the scene well")
          ->excludes(output)
          ->excludes(list);
  command
      .add_flag("--path", arguments->path,
                "Only print a flight through the scene for `voxdag render --path`")
      ->excludes(output)
      ->excludes(list)
      ->excludes(view);
  add_parsed_option(command, "--size", arguments->options.size, parse_positive, "SIZE",
                    "How large or fine the scene is; see --list");
  command.add_option("--seed", arguments->options.seed, "Another seed gives another scene")
      ->check(whole_number(0, 0xffff'ffff))
      ->type_name("N")
      ->capture_default_str();
  add_quiet_option(command, session);
  add_json_option(command, session);
  command.callback([arguments, &session] {
    if (session.json && (arguments->view || arguments->path))
      throw CLI::ValidationError("--json", "has no effect with --view or --path");
    if (arguments->list) {
      if (!arguments->name.empty()) throw CLI::ValidationError("--list", "lists all scenes");
      session.work = [&session] { print_list(session.json); };
      return;
    }
    if (arguments->name.empty()) throw CLI::RequiredError("a scene's name (or --list)");
    if (arguments->view) {
      session.work = [arguments] {
        fmt::print("{}\n", view_options(scene_preset(arguments->name, arguments->options)));
      };
      return;
    }
    if (arguments->path) {
      session.work = [arguments] {
        fmt::print("{}", path_json(path_file(scene_preset(arguments->name, arguments->options))));
      };
      return;
    }
    if (arguments->output.empty()) throw CLI::RequiredError("--output");
    session.work = [arguments, &session] { make(*arguments, session); };
  });
}

}  // namespace voxdag
