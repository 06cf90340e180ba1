/// The command line of `voxdag bench esvo`.
#include <fmt/core.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "cli/device.hpp"
#include "cli/parse.hpp"
#include "lab/commands/bench_output.hpp"
#include "lab/commands/commands.hpp"
#include "lab/esvo/bench_esvo.hpp"
#include "lab/report/bench_machine.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag::lab {
namespace {

struct BenchEsvoArguments {
  EsvoBenchPlan plan;
  std::vector<std::string> scenes;
  BenchOutput output;
};

void run(const BenchEsvoArguments& arguments, Session& session) {
  arguments.output.check_writable(session.progress);
  const nlohmann::ordered_json machine = machine_json();
  const EsvoBenchResults results = bench_esvo(arguments.plan, session.progress);
  arguments.output.write(
      esvo_bench_json(results, machine),
      {[&](const std::string& file) { return esvo_bench_chart(results, file); },
       [&](const std::string& file) { return esvo_rays_chart(results, file); }},
      fmt::format("{}{}, {} threads, load average {:.2f} before\n\n{}",
                  results.cuda_device.empty() ? "" : results.cuda_device + "; ",
                  machine.at("processor").get<std::string>(), results.threads,
                  machine.at("load_average").get<double>(), esvo_bench_table(results)),
      session);
  for (const EsvoBuildRun& build : results.builds)
    if (!build.failure.empty())
      throw Error(build.scene, std::to_string(1 << build.levels), build.failure);
  if (!results.device_failure.empty()) throw Error("--device cuda", "", results.device_failure);
  for (const EsvoRateRow& row : results.rates)
    if (row.least_agreement_with_cpu() < 1)
      throw Error(row.scene, fmt::format("{} x {} pixels", row.size.width, row.size.height),
                  fmt::format("hits of {} differ from the CPU's", results.cuda_device));
}

}  // namespace

void add_bench_esvo_command(const Command& bench_command, Session& session) {
  const auto arguments = std::make_shared<BenchEsvoArguments>();
  EsvoBenchPlan& plan = arguments->plan;
  plan.levels = {10, 11, 12};
  plan.sizes = {{512, 384}, {1024, 768}, {2048, 1536}};
  const Command command = bench_command.add(
      "esvo",
      "Measure size, build time, rays per second and silhouettes of ESVOs, with and without "
      "contours",
      "voxdag bench esvo Sibenik=sibenik.obj 'Sponza=sponza.obj --max-error 0.5' -r 1K,2K,4K\n"
      "For scenes of the paper, the tables also show the paper's figures (bench/README.md). "
      "Scratch files go to TMPDIR.");
  const Option scenes =
      command
          .texts("scenes", arguments->scenes, "NAME=MESH...",
                 "Scenes. Each is one argument: NAME=MESH, then options of `build`. "
                 "MESH is a file or a procedural scene (NAME or NAME:SIZE)")
          .required();
  command.list("-r,--resolution", plan.levels, parse_levels, "N,N...",
               "Voxels per side (default: 1K,2K,4K)");
  command.list("--size", plan.sizes, parse_image_size, "WxH,WxH...",
               "Sizes of the pictures whose rays are cast, in pixels (default: "
               "512x384,1024x768,2048x1536)");
  command.number("--views", plan.views, NumberRange::whole(1, 64), "N", "Number of cameras");
  command.number("--repeat", plan.repeat, NumberRange::whole(1, 1000), "N",
                 "Number of casts; the fastest counts");
  command.number("--lod", plan.lod_pixels, NumberRange::from(0, 1000), "PIXELS",
                 "End rays at cells of this size in the picture; 0: always at voxels");
  command.off_switch("--no-silhouettes", plan.silhouettes,
                     "Do not compare silhouettes with those of the mesh");
  add_output_options(command, arguments->output,
                     "Plot megabytes, seconds and silhouettes over the resolution");
  command.text("--rays-plot", arguments->output.plot_files[1], "FILE.svg",
               "Plot bars of rays per second");
  add_device_option(command, plan.device);
  add_run_options(command, session);
  command.when_parsed([arguments, scenes, &session] {
    for (const std::string& text : arguments->scenes) {
      try {
        arguments->plan.scenes.push_back(parse_esvo_scene(text));
      } catch (const std::invalid_argument& wrong) {
        throw UsageError(scenes.name(), fmt::format("\"{}\": {}", text, wrong.what()));
      }
      session.inputs.push_back(arguments->plan.scenes.back().mesh);
    }
    std::sort(arguments->plan.levels.begin(), arguments->plan.levels.end());
    arguments->output.check_distinct(session);
    session.work = [arguments, &session] {
      arguments->plan.threads = session.threads;
      run(*arguments, session);
    };
  });
}

}  // namespace voxdag::lab
