/// The command line of `voxdag bench attributes`.
#include <algorithm>
#include <memory>
#include <stdexcept>

#include "cli/mesh_input.hpp"
#include "cli/parse.hpp"
#include "lab/attributes/bench_attributes.hpp"
#include "lab/commands/bench_output.hpp"
#include "lab/commands/commands.hpp"

namespace voxdag::lab {
namespace {

struct BenchAttributesArguments {
  AttributesPlan plan;
  MeshAccess access;
  BenchOutput output;
};

std::string known_codecs() {
  std::string names;
  for (const ColorCodec codec : kColorCodecs) names += (names.empty() ? "" : ", ") + key_of(codec);
  return names;
}

ColorCodec parse_codec(const std::string& text) {
  for (const ColorCodec codec : kColorCodecs)
    if (key_of(codec) == text) return codec;
  throw std::invalid_argument("must be one of " + known_codecs());
}

double parse_bound(const std::string& text) {
  const std::vector<double> numbers = parse_numbers(text);
  if (numbers.size() != 1 || !(numbers[0] >= 0 && numbers[0] <= 1))
    throw std::invalid_argument("must be a number from 0 to 1");
  return numbers[0];
}

void run(const BenchAttributesArguments& arguments, Session& session) {
  const AttributesResults results = measure_and_write(
      "attributes", arguments.output, session,
      [&] { return bench_attributes(arguments.plan, session.progress); }, attributes_json);
  throw_failure(results.runs);
}

void finish_plan(AttributesPlan& plan, const MeshAccess& access) {
  access.give_rights(plan.read);
  std::sort(plan.levels.begin(), plan.levels.end());
  sort_unique(plan.codecs);
}

}  // namespace

void add_bench_attributes_command(const Command& bench, Session& session) {
  const auto arguments = std::make_shared<BenchAttributesArguments>();
  AttributesPlan& plan = arguments->plan;
  plan.levels = {10, 11};
  plan.bounds = {0.03, 0.04, 0.05, 0.06, 0.08};
  plan.thresholds = {0.05, 0.1};
  plan.codecs = {std::begin(kColorCodecs), std::end(kColorCodecs)};
  const Command command = bench.add(
      "attributes", "Measure bytes, errors and pictures of a DAG's colours in several codecs",
      "voxdag bench attributes sponza.obj -r 1024,2048 -o attributes.json --plot attributes.svg");
  command
      .texts("scenes", plan.scenes, "MESH...",
             "Mesh files, or procedural scenes as NAME or NAME:SIZE")
      .required();
  command.list("-r,--resolution", plan.levels, parse_levels, "N,N...",
               "Voxels per side; all cells get colours (default: 1024,2048)");
  command.list("--bounds", plan.bounds, parse_bound, "D,D...",
               "Largest errors of voxdag's colours, as `build --color-bound` takes them (default: "
               "0.03,0.04,0.05,0.06,0.08)");
  command.list("--thresholds", plan.thresholds, parse_bound, "D,D...",
               "Largest errors of the colours of Dolonius's codec, as distances in sRGB, each "
               "channel from 0 to 1 (default: 0.05,0.1)");
  command.list("--codecs", plan.codecs, parse_codec, "CODEC,CODEC...",
               "Any of " + known_codecs() + " (default: all)");
  command.number("--views", plan.views, NumberRange::whole(1, 100), "N",
                 "Number of pictures to compare; their views are chosen automatically");
  add_mesh_access_options(command, arguments->access);
  add_output_options(command, arguments->output, "Plot MS-SSIM against bits per voxel");
  add_run_options(command, session);
  command.when_parsed([arguments, &session] {
    finish_plan(arguments->plan, arguments->access);
    session.inputs = arguments->plan.scenes;
    arguments->output.check_distinct(session);
    session.work = [arguments, &session] { run(*arguments, session); };
  });
}

}  // namespace voxdag::lab
