/// The command line of `voxdag bench compact-rays`.
#include <filesystem>
#include <memory>

#include "cli/parse.hpp"
#include "lab/commands/bench_output.hpp"
#include "lab/commands/commands.hpp"
#include "lab/compact_rays/compact_rays.hpp"
#include "voxdag/file/model/scene_model.hpp"

namespace voxdag::lab {
namespace {

struct BenchCompactRaysArguments {
  CompactRaysPlan plan;
  BenchOutput output;
};

void run(const BenchCompactRaysArguments& arguments, Session& session) {
  const auto measure = [&] {
    const DagModel file(session.subject, &session.progress);
    const std::string& source = file.metadata().source.name;
    return bench_compact_rays(
        source.empty() ? std::filesystem::path(session.subject).filename().string() : source,
        file.view(), file.grid(), arguments.plan, session.progress);
  };
  measure_and_write("compact-rays", arguments.output, session, measure, compact_rays_json);
}

}  // namespace

void add_bench_compact_rays_command(const Command& bench, Session& session) {
  const auto arguments = std::make_shared<BenchCompactRaysArguments>();
  const Command command = bench.add("compact-rays",
                                    "Measure rays at the compact form, as it is, with more and "
                                    "fewer tables",
                                    "voxdag bench compact-rays sponza.vdag --plot rays.svg");
  command.text("file", session.subject, "FILE", "The .vdag file, in either form").required();
  command.number("--views", arguments->plan.views, NumberRange::whole(1, 100), "N",
                 "Number of views whose rays are cast");
  command.number("--repeat", arguments->plan.repeat, NumberRange::whole(1, 1000), "N",
                 "Number of runs; the fastest counts");
  command.number("--rays", arguments->plan.most_rays, NumberRange::whole(1, 100'000'000), "N",
                 "Largest number of rays of a kind and view");
  add_output_options(command, arguments->output, "Plot the time per ray over the bytes");
  add_run_options(command, session);
  command.when_parsed([arguments, &session] {
    arguments->output.check_distinct(session);
    session.work = [arguments, &session] { run(*arguments, session); };
  });
}

}  // namespace voxdag::lab
