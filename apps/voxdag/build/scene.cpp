/// `voxdag scene`: writes procedural scenes as mesh files.
#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/commands.hpp"
#include "cli/output_files.hpp"
#include "cli/parse.hpp"
#include "cli/written_files.hpp"
#include "voxdag/core/lower_case.hpp"
#include "voxdag/formats/scenes/ply_writer.hpp"
#include "voxdag/formats/scenes/scenes.hpp"
#include "voxdag/render/film/path_file.hpp"

namespace voxdag::cli {
namespace {

struct SceneArguments {
  std::string name, output;
  SceneOptions options;
  bool list = false, view = false, path = false;
};

bool uses_seed(const std::string& scene) {
  for (const SceneInfo& info : scene_list())
    if (info.name == scene) return info.uses_seed;
  return true;
}

std::string option_text(const std::string& name, Vec3d v) {
  return fmt::format("{} {:.6g},{:.6g},{:.6g} ", name, v.x, v.y, v.z);
}

/// Returns options of `render` that show the scene well.
std::string view_options(const ScenePreset& preset) {
  return option_text("--eye", preset.eye) + option_text("--target", preset.target) +
         option_text("--up", preset.up) + option_text("--sun", preset.sun_direction) +
         fmt::format("--fov {:.6g}", preset.fov_degrees);
}

/// Returns the flight through the scene in the form that `render --path` reads.
PathFile path_file(const ScenePreset& preset) {
  PathFile path;
  path.sun = preset.sun_direction;
  path.keys = path_keys(preset.flight, preset.up, preset.fov_degrees);
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

void make(const SceneArguments& arguments, Session& session) {
  check_writable(arguments.output);
  const Mesh mesh = make_scene(arguments.name, arguments.options, &session.progress);
  write_ply(arguments.output, mesh, &session.progress);
  if (session.json) {
    const nlohmann::ordered_json summary = {{"file", with_output_name(arguments.output)},
                                            {"vertices", mesh.vertices.size()},
                                            {"triangles", mesh.triangles.size()}};
    fmt::print("{}", json_text(summary));
    return;
  }
  print_written({{arguments.output},
                 {{"triangles", mesh.triangles.size()}, {"vertices", mesh.vertices.size()}}},
                session);
}

/// Sets the work of the session. Throws UsageError if arguments are missing.
void choose_work(const std::shared_ptr<SceneArguments>& arguments, Session& session) {
  if (arguments->list) {
    session.work = [&session] { print_list(session.json); };
    return;
  }
  if (arguments->name.empty()) throw UsageError("name", "is required, unless --list is given");
  if (arguments->view) {
    session.work = [arguments] {
      fmt::print("{}\n", view_options(scene_preset(arguments->name, arguments->options)));
    };
  } else if (arguments->path) {
    session.work = [arguments] {
      fmt::print("{}", path_json(path_file(scene_preset(arguments->name, arguments->options))));
    };
  } else {
    if (arguments->output.empty()) throw UsageError("--output", "is required");
    const std::string ending =
        lower_case(std::filesystem::path(arguments->output).extension().string());
    if (!ending.empty() && ending != ".ply" && !is_pipe_or_device(arguments->output))
      throw UsageError("--output", fmt::format("writes a mesh, FILE.ply, not {}", ending));
    session.work = [arguments, &session] { make(*arguments, session); };
  }
}

}  // namespace

void add_scene_command(const Command& program, Session& session) {
  const auto arguments = std::make_shared<SceneArguments>();
  const Command command = program.add("scene", "Write a procedural scene as a PLY mesh",
                                      "voxdag scene courtyard -o courtyard.ply");
  const Option name =
      command.text("name", arguments->name, "NAME", "Name of the scene; --list prints all names");
  const Option output =
      command.text("-o,--output", arguments->output, "FILE.ply", "The mesh to write");
  const Option list =
      command.flag("--list", arguments->list, "Only list the scenes and what their sizes mean");
  const Option view =
      command.flag("--view", arguments->view,
                   "Only print options with which `voxdag render` shows the scene well");
  const Option path = command.flag("--path", arguments->path,
                                   "Only print a camera path for `voxdag render --path`");
  const Option size = command.parsed("--size", arguments->options.size, parse_positive, "SIZE",
                                     "Size or fineness of the scene (default: see --list)");
  const Option seed =
      command.number("--seed", arguments->options.seed, NumberRange::whole(0, 0xffff'ffff), "N",
                     "Seed of the random numbers");
  add_json_option(command, session).not_with(view).not_with(path);
  add_quiet_option(command, session).not_with(list).not_with(view).not_with(path);
  output.not_with(list).not_with(view).not_with(path);
  view.not_with(list);
  path.not_with(list).not_with(view);
  for (const Option& option : {name, size, seed}) option.not_with(list);
  seed.not_with(view).not_with(path).only_if([arguments] { return uses_seed(arguments->name); },
                                             "on this scene, which uses no random numbers");
  command.when_parsed([arguments, &session] { choose_work(arguments, session); });
}

}  // namespace voxdag::cli
