/// The command line of `voxdag bench papers`.
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>

#include "cli/device.hpp"
#include "cli/job.hpp"
#include "cli/parse.hpp"
#include "lab/commands/commands.hpp"
#include "lab/papers/paper_scenes.hpp"
#include "lab/reproduce/bench_papers.hpp"
#include "voxdag/file/report/human.hpp"

namespace voxdag::lab {
namespace {

struct PapersArguments {
  PapersPlan plan;
  std::string scenes, folder;
  std::vector<int> table1, table2, esvo;  ///< Levels; empty: those of the plan.
  std::optional<int> flight_esvo, flight_triangles, frames, figure1, pictures, esvo_pictures;
  std::optional<ImageSize> size;
  std::optional<double> cell_seconds;
  bool quick = false;
};

std::vector<int> sorted(std::vector<int> levels) {
  std::sort(levels.begin(), levels.end());
  levels.erase(std::unique(levels.begin(), levels.end()), levels.end());
  return levels;
}

/// Returns the name of a scene in the papers' tables.
std::string parse_paper_scene(const std::string& text) {
  std::set<std::string_view> known;
  for (const PaperScene& scene : paper_scenes()) known.insert(scene.name);
  if (!known.contains(text))
    throw std::invalid_argument(fmt::format("must be one of {}", fmt::join(known, ", ")));
  return text;
}

void run(const PapersArguments& arguments, Session& session) {
  Job& job = join_job(session);
  PapersPlan plan = arguments.plan;
  plan.scenes = arguments.scenes;
  if (arguments.quick) make_quick(plan);
  if (!arguments.table1.empty()) plan.table1_levels = sorted(arguments.table1);
  if (!arguments.table2.empty()) plan.table2_levels = sorted(arguments.table2);
  if (!arguments.esvo.empty()) plan.esvo.levels = sorted(arguments.esvo);
  plan.esvo.picture_levels = arguments.esvo_pictures.value_or(plan.esvo.picture_levels);
  plan.cell_seconds = arguments.cell_seconds.value_or(plan.cell_seconds);
  FlightPlan& flight = plan.flight;
  flight.esvo_levels = arguments.flight_esvo.value_or(flight.esvo_levels);
  flight.triangles_levels = arguments.flight_triangles.value_or(flight.triangles_levels);
  flight.frames = arguments.frames.value_or(flight.frames);
  flight.size = arguments.size.value_or(flight.size);
  plan.figure1_levels = arguments.figure1.value_or(plan.figure1_levels);
  plan.pictures.levels = arguments.pictures.value_or(plan.pictures.levels);
  plan.pictures.size = arguments.size.value_or(plan.pictures.size);
  if (arguments.size) plan.esvo.sizes = {*arguments.size};
  plan.folder = std::filesystem::absolute(arguments.folder);
  plan.threads = session.threads;
  if (!session.quiet)
    fmt::print(stderr,
               "voxdag: takes about {} on two cores; finished measurements are kept in {}\n",
               human_duration(typical_seconds(plan)), arguments.folder);
  const PapersReport report = bench_papers(plan, job.ranks(), session.progress);
  if (!job.is_first()) return;
  session.bar.clear();
  fmt::print(
      "{}: {} measured{}, {} kept from earlier runs{}\n", report.html.string(), report.measured,
      job.count() == 1
          ? ""
          : fmt::format(" by {} processes ({})", job.count(), fmt::join(report.measured_by, " + ")),
      report.kept, report.has_charts ? "" : "; no charts, because matplotlib is not installed");
}

}  // namespace

void add_bench_papers_command(const Command& bench, Session& session) {
  const auto arguments = std::make_shared<PapersArguments>();
  const Command command = bench.add(
      "papers", "Measure the tables and figures of both papers again, and write a report",
      "voxdag bench papers --scenes DIR -o report\n"
      "With --quick instead of --scenes it takes a few minutes. An interrupted run continues where "
      "it stopped if it is started again with the same folder. Under mpirun or srun, the processes "
      "share the runs; those on one machine disturb one another's times.");
  command.text("-o,--output", arguments->folder, "DIR", "The folder for the report").required();
  const Option scenes =
      command.text("--scenes", arguments->scenes, "DIR",
                   "The folder of the meshes (default: the variable VOXDAG_SCENES; without it, "
                   "procedural scenes alone)");
  command.flag("--quick", arguments->quick, "Coarse resolutions and procedural scenes only")
      .not_with(scenes);
  command.list("--only", arguments->plan.only, parse_paper_scene, "SCENE,SCENE...",
               "Only these scenes, as the papers name them (default: all)");
  command.list("--table1", arguments->table1, parse_levels, "N,N...",
               "Resolutions of the SVDAG paper's Table 1 (default: 512,1K,2K,4K,8K)");
  command.list("--table2", arguments->table2, parse_levels, "N,N...",
               "Resolutions of the SVDAG paper's Table 2 (default: 2K,4K,8K,16K,32K,64K)");
  command.list("--esvo-tables", arguments->esvo, parse_levels, "N,N...",
               "Resolutions of the ESVO paper's tables (default: 1K,2K,4K,8K,16K,32K,64K)");
  command.parsed("--flight-esvo", arguments->flight_esvo, parse_levels, "N",
                 "Resolution of the fly-through with DAG and ESVO (default: 4K)");
  command.parsed("--flight-triangles", arguments->flight_triangles, parse_levels, "N",
                 "Resolution of the fly-through with DAG and triangles (default: 32K)");
  command.optional_number<int>("--frames", arguments->frames, NumberRange::whole(1, 10'000), "N",
                               "Frames of the fly-through (default: 30)");
  command.parsed("--figure1", arguments->figure1, parse_levels, "N",
                 "Resolution of the SVDAG paper's Figure 1 (default: 128K)");
  command.parsed("--pictures", arguments->pictures, parse_levels, "N",
                 "Resolution of the SVDAG paper's pictures (default: 8K)");
  command.parsed("--esvo-pictures", arguments->esvo_pictures, parse_levels, "N",
                 "Resolution of the ESVO paper's pictures (default: 2K)");
  command.parsed("--size", arguments->size, parse_image_size, "WxH",
                 "Size of frames and pictures in pixels (default: the papers' sizes for frames, "
                 "960x540 for pictures)");
  command.optional_number<double>(
      "--cell-seconds", arguments->cell_seconds, NumberRange::from(1, 1e6), "SECONDS",
      "Time limit of one run; the report names the runs that it excludes (default: 600, with "
      "--quick 20)");
  command.parsed("--memory", arguments->plan.memory_bytes, parse_memory, "LIMIT",
                 "Maximum memory of one build: 512M, 16GiB (default: three quarters of the "
                 "available memory)");
  add_device_option(command, arguments->plan.device_choice);
  add_threads_option(command, session);
  add_quiet_option(command, session);
  command.when_parsed([arguments, &session] {
    const char* variable = std::getenv("VOXDAG_SCENES");
    if (arguments->scenes.empty() && variable != nullptr) arguments->scenes = variable;
    session.work = [arguments, &session] { run(*arguments, session); };
  });
}

}  // namespace voxdag::lab
