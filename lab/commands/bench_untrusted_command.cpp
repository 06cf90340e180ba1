/// The command line of `voxdag bench untrusted`.
#include <fmt/core.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "lab/commands/bench_output.hpp"
#include "lab/commands/commands.hpp"
#include "lab/runs/machine.hpp"
#include "lab/runs/scene_mesh.hpp"
#include "lab/untrusted/untrusted.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag::lab {

void add_bench_untrusted_command(const Command& bench_command, Session& session) {
  struct Arguments {
    UntrustedPlan plan;
    BenchOutput output;
  };
  const auto arguments = std::make_shared<Arguments>();
  const Command command = bench_command.add(
      "untrusted",
      "Run hostile inputs; print their time, their memory and the promises that they break",
      "voxdag bench untrusted\n"
      "docs/security.md lists the promises. The exit status is 1 if a case breaks one.");
  command.text("--program", arguments->plan.program, "FILE",
               "The voxdag to test (default: this program)");
  command.text("--only", arguments->plan.only, "TEXT", "Run only cases whose names contain TEXT");
  command.number("--timeout", arguments->plan.timeout_seconds, NumberRange::from(1, 86400),
                 "SECONDS", "Time limit for each command, in seconds");
  command.text("-o,--output", arguments->output.json_file, "FILE.json",
               "Also write the JSON to a file");
  add_quiet_option(command, session);
  add_json_option(command, session);
  command.when_parsed([arguments, &session] {
    session.work = [arguments, &session] {
      arguments->output.check_writable(session.progress);
      UntrustedPlan plan = arguments->plan;
      if (plan.program.empty()) plan.program = voxdag_program();
      plan.program = std::filesystem::canonical(plan.program).string();
      const nlohmann::ordered_json machine = machine_json();
      const std::vector<UntrustedRun> runs = bench_untrusted(plan, session.progress);
      arguments->output.write(untrusted_json(runs, machine), untrusted_table(runs), session);
      for (const UntrustedRun& run : runs)
        if (!run.failure.empty()) throw Error("\"" + run.name + "\" " + run.failure);
    };
  });
}

}  // namespace voxdag::lab
