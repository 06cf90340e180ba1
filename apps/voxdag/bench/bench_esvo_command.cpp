/// The command line of `voxdag bench esvo`.
#include <fmt/core.h>

#include <algorithm>
#include <memory>

#include "bench/bench_output.hpp"
#include "bench/esvo/bench_esvo.hpp"
#include "bench/report/bench_machine.hpp"
#include "cli/commands.hpp"
#include "cli/number_check.hpp"
#include "cli/parse.hpp"

namespace voxdag {
namespace {

struct BenchEsvoArguments {
  EsvoBenchPlan plan;
  std::vector<std::string> scenes, resolutions{"1K", "2K", "4K"},
      sizes{"512x384", "1024x768", "2048x1536"};
  BenchOutput output;
};

void run(const BenchEsvoArguments& arguments, Session& session) {
  arguments.output.check_writable();
  const nlohmann::ordered_json machine = machine_json();
  const EsvoBenchResults results = bench_esvo(arguments.plan, session.progress);
  arguments.output.write(
      esvo_bench_json(results, machine),
      {[&] { return esvo_bench_svg(results); }, [&] { return esvo_rays_svg(results); }},
      fmt::format("{}, {} threads, load average {:.2f} before\n\n{}",
                  machine.at("processor").get<std::string>(), results.threads,
                  machine.at("load_average").get<double>(), esvo_bench_table(results)),
      session);
  for (const EsvoBuildRun& build : results.builds)
    if (!build.failure.empty())
      throw Error(build.scene, std::to_string(1 << build.levels), build.failure);
}

}  // namespace

void add_bench_esvo_command(CLI::App& parent, Session& session) {
  const auto arguments = std::make_shared<BenchEsvoArguments>();
  EsvoBenchPlan& plan = arguments->plan;
  CLI::App& command = *parent.add_subcommand(
      "esvo", "Size, time, rays and silhouettes of ESVOs, with contours and without");
  command.footer(
      "Example:\n  voxdag bench esvo Sibenik=sibenik.obj 'Sponza=sponza.obj --max-error 0.5' "
      "-r 1K,2K,4K\n"
      "A scene of the paper's name stands beside the paper's figures. Scratch files go to TMPDIR.");
  command
      .add_option("scenes", arguments->scenes,
                  "NAME=MESH, and options of build after it; the mesh is a file, or a procedural "
                  "scene as NAME or NAME:SIZE")
      ->type_name("NAME=MESH")
      ->required();
  command
      .add_option("-r,--resolution", arguments->resolutions,
                  "Voxels a side, several with commas (default: 1K,2K,4K)")
      ->delimiter(',')
      ->type_name("N,N...");
  command
      .add_option("--size", arguments->sizes,
                  "Pixels of the pictures whose rays are cast, several with commas (default: "
                  "512x384,1024x768,2048x1536)")
      ->delimiter(',')
      ->type_name("WxH,WxH...");
  command.add_option("--views", plan.views, "Cameras")
      ->check(whole_number(1, 64))
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--repeat", plan.repeat, "Cast so often and take the fastest")
      ->check(whole_number(1, 1000))
      ->type_name("N")
      ->capture_default_str();
  command.add_option("--lod", plan.lod_pixels, "Rays end at cells of so many pixels; 0: voxels")
      ->check(number_from(0, 1000))
      ->type_name("PIXELS")
      ->capture_default_str();
  command.add_flag_callback(
      "--no-silhouettes", [&plan] { plan.silhouettes = false; },
      "Leave out the comparison with the mesh at every resolution");
  command.add_option("-o,--output", arguments->output.json_file, "Write the JSON to a file, too")
      ->type_name("FILE.json");
  command
      .add_option("--plot", arguments->output.plot_files[0],
                  "Draw megabytes, seconds and silhouettes over the resolution")
      ->type_name("FILE.svg");
  command
      .add_option("--rays-plot", arguments->output.plot_files[1], "Draw bars of rays per second")
      ->type_name("FILE.svg");
  add_threads_option(command, session);
  add_quiet_option(command, session);
  add_json_option(command, session);
  command.callback([arguments, &session] {
    parse_all("scenes", arguments->scenes, parse_esvo_scene, arguments->plan.scenes);
    parse_all("--resolution", arguments->resolutions, parse_levels, arguments->plan.levels);
    parse_all("--size", arguments->sizes, parse_image_size, arguments->plan.sizes);
    std::sort(arguments->plan.levels.begin(), arguments->plan.levels.end());
    for (const EsvoBenchScene& scene : arguments->plan.scenes) session.inputs.push_back(scene.mesh);
    arguments->output.check_distinct(session);
    session.work = [arguments, &session] {
      arguments->plan.threads = session.threads;
      run(*arguments, session);
    };
  });
}

}  // namespace voxdag
