/// The command line of `voxdag bench compact`.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <stdexcept>

#include "cli/mesh_input.hpp"
#include "cli/parse.hpp"
#include "lab/commands/bench_output.hpp"
#include "lab/commands/commands.hpp"
#include "lab/compact/bench_compact.hpp"

namespace voxdag::lab {
namespace {

struct BenchCompactArguments {
  CompactPlan plan;
  MeshAccess access;
  BenchOutput output;
};

std::string known_forms() {
  std::string names;
  for (const CompactForm& form : compact_forms())
    names += (names.empty() ? "" : ", ") + std::string(form.key);
  return names;
}

const CompactForm* parse_form(const std::string& text) {
  for (const CompactForm& form : compact_forms())
    if (form.key == text) return &form;
  throw std::invalid_argument("must be one of " + known_forms());
}

void run(const BenchCompactArguments& arguments, Session& session) {
  const CompactResults results = measure_and_write(
      "compact", arguments.output, session,
      [&] { return bench_compact(arguments.plan, session.progress); }, compact_json);
  throw_failure(results.runs);
}

void finish_plan(CompactPlan& plan, const MeshAccess& access) {
  access.give_rights(plan.read);
  std::sort(plan.levels.begin(), plan.levels.end());
  if (plan.forms.empty())
    for (const CompactForm& form : compact_forms()) plan.forms.push_back(&form);
  sort_unique(plan.forms);
}

}  // namespace

void add_bench_compact_command(const Command& bench, Session& session) {
  const auto arguments = std::make_shared<BenchCompactArguments>();
  CompactPlan& plan = arguments->plan;
  plan.levels = {11, 12};
  const Command command =
      bench.add("compact", "Measure the bytes of DAGs in the compact forms of several papers",
                "voxdag bench compact sponza.obj lucy.vdag -r 2048,4096,8192 --plot compact.svg\n"
                "A .vdag file keeps its own resolution.");
  command
      .texts("scenes", plan.scenes, "MESH...",
             "Mesh files, procedural scenes as NAME or NAME:SIZE, or .vdag files of DAGs")
      .required();
  command.list("-r,--resolution", plan.levels, parse_levels, "N,N...",
               "Voxels per side of meshes (default: 2048,4096)");
  command.list("--forms", plan.forms, parse_form, "FORM,FORM...",
               "Any of " + known_forms() + " (default: all)");
  add_mesh_access_options(command, arguments->access);
  add_output_options(command, arguments->output, "Plot bars of bits per voxel");
  add_run_options(command, session);
  command.when_parsed([arguments, &session] {
    finish_plan(arguments->plan, arguments->access);
    session.inputs = arguments->plan.scenes;
    arguments->output.check_distinct(session);
    session.work = [arguments, &session] { run(*arguments, session); };
  });
}

}  // namespace voxdag::lab
