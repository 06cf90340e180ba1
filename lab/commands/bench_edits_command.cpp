/// The command line of `voxdag bench edits`.
#include <algorithm>
#include <memory>
#include <stdexcept>

#include "cli/parse.hpp"
#include "lab/commands/bench_output.hpp"
#include "lab/commands/commands.hpp"
#include "lab/edits/bench_edits.hpp"

namespace voxdag::lab {
namespace {

double parse_radius(const std::string& text) {
  const std::vector<double> numbers = parse_numbers(text);
  if (numbers.size() != 1 || !(numbers[0] >= 0 && numbers[0] <= 100000))
    throw std::invalid_argument("must be a number from 0 to 100000");
  return numbers[0];
}

}  // namespace

void add_bench_edits_command(const Command& bench, Session& session) {
  struct Arguments {
    EditsPlan plan;
    BenchOutput output;
  };
  const auto arguments = std::make_shared<Arguments>();
  EditsPlan& plan = arguments->plan;
  plan.radii = {4, 16, 47, 150, 443, 1000, 2300};
  const Command command =
      bench.add("edits", "Measure milliseconds, nodes and bytes of edits of DAGs",
                "voxdag bench edits sponza.vdag --replay session.csv -o edits.json");
  command.texts("scenes", plan.scenes, "FILE.vdag...", "DAGs to edit; the files do not change")
      .required();
  command.texts("--replay", plan.replays, "FILE.csv...",
                "Recorded sessions of HashDAG. Each ball is placed on a voxel of the scene");
  command.list("--radius", plan.radii, parse_radius, "R,R...",
               "Radii of single balls, in voxels (default: 4,16,47,150,443,1000,2300)");
  command.number("--repeat", plan.repeats, NumberRange::whole(1, 10000), "N",
                 "Number of balls of each radius");
  command.number("--session", plan.session, NumberRange::whole(0, 10000000), "N",
                 "Number of edits of a long session, of which the last 1,000 can be undone");
  command.text("-o,--output", arguments->output.json_file, "FILE.json",
               "Also write the JSON to a file");
  add_run_options(command, session);
  command.when_parsed([arguments, &session] {
    session.work = [arguments, &session] {
      arguments->output.check_writable(session.progress);
      const nlohmann::ordered_json machine = machine_json();
      const std::vector<EditsRun> runs = bench_edits(arguments->plan, session.progress);
      arguments->output.write(edits_json(runs, machine), machine_text(machine) + edits_table(runs),
                              session);
    };
  });
}

}  // namespace voxdag::lab
