/// `voxdag bench`: measures this program, and others beside it.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <memory>

#include "bench/bench_output.hpp"
#include "bench/build/bench_build.hpp"
#include "bench/build/bench_report.hpp"
#include "bench/report/bench_machine.hpp"
#include "cli/commands.hpp"
#include "cli/number_check.hpp"
#include "cli/parse.hpp"
#include "voxdag/scenes/scenes.hpp"

namespace voxdag {
namespace {

struct BenchArguments {
  BenchPlan plan;
  std::vector<std::string> resolutions, rivals;
  BenchOutput output;
};

constexpr std::array kDefaultResolutions{"512", "1024", "2048"};

/// "NAME=COMMAND".
Rival parse_rival(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == 0 || equals == std::string::npos || equals + 1 == text.size())
    throw CLI::ValidationError("--rival", "\"" + text + "\" is not NAME=COMMAND");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

void finish_plan(BenchArguments& arguments) {
  BenchPlan& plan = arguments.plan;
  if (plan.meshes.empty())
    for (const SceneInfo& scene : scene_list()) plan.meshes.emplace_back(scene.name);
  if (arguments.resolutions.empty())
    arguments.resolutions.assign(kDefaultResolutions.begin(), kDefaultResolutions.end());
  parse_all("--resolution", arguments.resolutions, parse_levels, plan.levels);
  std::sort(plan.levels.begin(), plan.levels.end());
  for (const std::string& text : arguments.rivals) plan.rivals.push_back(parse_rival(text));
}

void bench(const BenchArguments& arguments, Session& session) {
  arguments.output.check_writable();
  const nlohmann::ordered_json machine = machine_json();
  const BenchResults results = bench_build(arguments.plan, session.progress);
  arguments.output.write(
      bench_json(results, machine), {[&] { return bench_svg(results); }},
      fmt::format("{} ({} cores), load average {:.2f} before\n\n{}",
                  machine.at("processor").get<std::string>(), machine.at("cores").get<int>(),
                  machine.at("load_average").get<double>(), bench_table(results)),
      session);
  for (const BuildRun& run : results.builds)
    if (!run.failure.empty()) throw Error(run.scene, std::to_string(1 << run.levels), run.failure);
}

void add_build(CLI::App& parent, Session& session) {
  const auto arguments = std::make_shared<BenchArguments>();
  BenchPlan& plan = arguments->plan;
  plan.methods = {"hash"};
  CLI::App& command = *parent.add_subcommand(
      "build", "Time, memory and growth of builds; every run is a process of its own");
  command.footer(
      "Example:\n  voxdag bench build sponza.obj hairball -r 2048,4096,8192 --plot growth.svg\n"
      "Other programs beside ours: --rival 'other=other-program {mesh} {resolution} {out}'\n"
      "Scratch files go to TMPDIR.");
  command
      .add_option("meshes", plan.meshes,
                  "Mesh files, or procedural scenes as NAME or NAME:SIZE (default: all scenes)")
      ->type_name("MESH");
  command
      .add_option("-r,--resolution", arguments->resolutions,
                  "Voxels a side, several with commas (default: 512,1024,2048)")
      ->delimiter(',')
      ->type_name("N,N...");
  command.add_option("--method", plan.methods, "hash, sort or both with a comma (default: hash)")
      ->delimiter(',')
      ->check(CLI::IsMember({"hash", "sort"}))
      ->type_name("METHOD");
  command
      .add_option("--rival", arguments->rivals,
                  "Another program, as NAME=COMMAND for the shell, with {mesh}, {out}, "
                  "{resolution} and {levels}; can be given again")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->type_name("NAME=COMMAND");
  command.add_option("--rival-seconds", plan.rival_seconds, "End a rival after so long")
      ->check(positive_number())
      ->type_name("S");
  command.add_option("--repeat", plan.repeat, "Measure so often and take the fastest")
      ->check(whole_number(1, 1000))
      ->type_name("N");
  command.add_option("-o,--output", arguments->output.json_file, "Write the JSON to a file, too")
      ->type_name("FILE.json");
  command
      .add_option("--plot", arguments->output.plot_files[0],
                  "Draw seconds and bytes over the resolution")
      ->type_name("FILE.svg");
  add_threads_option(command, session);
  add_quiet_option(command, session);
  add_json_option(command, session);
  command.callback([arguments, &session] {
    finish_plan(*arguments);
    session.inputs = arguments->plan.meshes;
    arguments->output.check_distinct(session);
    session.work = [arguments, &session] {
      arguments->plan.threads = session.threads;
      bench(*arguments, session);
    };
  });
}

}  // namespace

void add_bench_command(CLI::App& app, Session& session) {
  CLI::App& command = add_command(app, "bench", "Measure builds and rays, and others beside them",
                                  "voxdag bench build sponza.obj -r 2048,4096,8192");
  command.require_subcommand(1);
  add_build(command, session);
  add_bench_trace_command(command, session);
  add_bench_esvo_command(command, session);
}

}  // namespace voxdag
