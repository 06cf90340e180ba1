/// The command line of `voxdag bench build`.
#include <algorithm>
#include <memory>
#include <stdexcept>

#include "cli/mesh_input.hpp"
#include "cli/parse.hpp"
#include "lab/build/bench_build.hpp"
#include "lab/build/bench_report.hpp"
#include "lab/commands/bench_output.hpp"
#include "lab/commands/commands.hpp"
#include "lab/rivals/command_rival.hpp"
#include "voxdag/builders/solid/solid_settings.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/formats/scenes/scenes.hpp"

namespace voxdag::lab {
namespace {

struct BenchArguments {
  BenchPlan plan;
  std::string solid;  ///< The rule of `build --solid`; empty: none.
  MeshAccess access;
  BenchOutput output;
};

std::string parse_method(const std::string& text) {
  if (text != "hash" && text != "sort" && text != "paper")
    throw std::invalid_argument("is not hash, sort or paper");
  return text;
}

/// Parses "NAME=COMMAND"; throws std::invalid_argument.
std::shared_ptr<Rival> parse_rival(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == std::string::npos || equals + 1 == text.size())
    throw std::invalid_argument("is not NAME=COMMAND");
  return std::make_shared<CommandRival>(text.substr(0, equals), text.substr(equals + 1));
}

void bench(const BenchArguments& arguments, Session& session) {
  const BenchResults results = measure_and_write(
      arguments.output, session, [&] { return bench_build(arguments.plan, session.progress); },
      bench_json, bench_chart, bench_table);
  for (const BuildRun& run : results.builds)
    if (!run.failure.empty()) throw Error(run.scene, std::to_string(1 << run.levels), run.failure);
}

std::string parse_solid(const std::string& text) { return name_of(solid_rule(text)); }

void finish_plan(BenchPlan& plan, const MeshAccess& access, const std::string& solid) {
  if (!solid.empty()) plan.build_options.insert(plan.build_options.end(), {"--solid", solid});
  if (access.allow_outside) plan.build_options.emplace_back("--allow-outside");
  if (access.any_importer) plan.build_options.insert(plan.build_options.end(), {"--assimp", "any"});
  if (plan.meshes.empty())
    for (const SceneInfo& scene : scene_list()) plan.meshes.emplace_back(scene.name);
  std::sort(plan.levels.begin(), plan.levels.end());
}

}  // namespace

void add_bench_build_command(const Command& bench_command, Session& session) {
  const auto arguments = std::make_shared<BenchArguments>();
  BenchPlan& plan = arguments->plan;
  plan.methods = {"hash"};
  plan.levels = {9, 10, 11};
  const Command command = bench_command.add(
      "build", "Measure time, memory and growth of builds, each in a process of its own",
      "voxdag bench build sponza.obj hairball -r 2048,4096,8192 --plot growth.svg\n"
      "Other programs: --rival 'other=other-program {mesh} {resolution} {out}'\n"
      "Scratch files go to TMPDIR.");
  command.texts(
      "meshes", plan.meshes, "MESH...",
      "Mesh files, or procedural scenes as NAME or NAME:SIZE (default: all procedural scenes)");
  command.list("-r,--resolution", plan.levels, parse_levels, "N,N...",
               "Voxels per side (default: 512,1024,2048)");
  command.list("--method", plan.methods, parse_method, "METHOD,METHOD",
               "Any of hash, sort and paper, as in voxdag build (default: hash)");
  command.flag_or_parsed("--solid", arguments->solid, parse_solid, "parity", "parity|winding|flood",
                         "Also set the voxels inside, as voxdag build does");
  const Option rival = command.repeated(
      "--rival", plan.rivals, parse_rival, "NAME=COMMAND",
      "Run another program for comparison: a shell command with {mesh}, {out}, {resolution} and "
      "{levels}; repeatable");
  command
      .number("--rival-seconds", plan.rival_seconds, NumberRange::positive(), "S",
              "Time limit for a rival, in seconds")
      .needs(rival);
  command.number("--repeat", plan.repeat, NumberRange::whole(1, 1000), "N",
                 "Number of runs; the fastest counts");
  add_mesh_access_options(command, arguments->access);
  add_output_options(command, arguments->output, "Plot seconds and bytes over the resolution");
  add_run_options(command, session);
  command.when_parsed([arguments, &session] {
    finish_plan(arguments->plan, arguments->access, arguments->solid);
    session.inputs = arguments->plan.meshes;
    arguments->output.check_distinct(session);
    session.work = [arguments, &session] {
      arguments->plan.threads = session.threads;
      bench(*arguments, session);
    };
  });
}

}  // namespace voxdag::lab
