/// `voxdag build` in parts: in bounded memory, or by many processes.
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "build/build_arguments.hpp"
#include "cli/job.hpp"
#include "voxdag/algebra/coarsen.hpp"
#include "voxdag/cluster/parts_job.hpp"
#include "voxdag/core/io/process_memory.hpp"
#include "voxdag/core/io/temporary_folder.hpp"
#include "voxdag/cpu/presentation.hpp"
#include "voxdag/file/long_vdag_file.hpp"
#include "voxdag/file/model/dag_model.hpp"
#include "voxdag/file/model/written_by.hpp"
#include "voxdag/file/report/dag_report.hpp"
#include "voxdag/file/report/human.hpp"
#include "voxdag/formats/readers/used_vertices.hpp"

namespace voxdag::cli {
namespace {

DagReport report_of_file(const PartsReport& parts, const std::string& output) {
  DagReport report;
  report.metadata = parts.metadata;
  report.node_bytes = parts.node_bytes;
  report.leaf_bytes = parts.leaf_bytes;
  std::error_code unknown;
  report.file_bytes = std::filesystem::file_size(output, unknown);
  if (unknown) report.file_bytes = 0;  // the output is a pipe or a device
  return report;
}

/// Returns the presentation with a home for the voxels of a file, which may have long pointers.
Presentation presentation_of_file(const std::filesystem::path& path,
                                  const Presentation& presentation, Work work) {
  VdagContainer opened(path, work.memory);
  if (opened.kind() != VdagKind::kLong) {
    const DagModel file(std::move(opened), work);
    return with_home(presentation, file.view(), file.grid());
  }
  const LongVdagFile file(std::move(opened));
  const Svdag coarse = coarsen(file.view(), std::min(file.view().levels, 10), work);
  const Grid grid = coarser_metadata(file.metadata(), coarse.view()).grid;
  return with_home(presentation, coarse.view(), grid);
}

double total_seconds(const PartsReport& parts) {
  double sum = 0;
  for (const double seconds : parts.seconds) sum += seconds;
  return sum;
}

nlohmann::ordered_json json_of(const DagReport& report, const PartsReport& parts, int ranks) {
  nlohmann::ordered_json json = dag_json(report);
  json["ranks"] = ranks;
  json["parts"] = parts.parts;
  json["parts_built"] = parts.built;
  json["mailboxes"] = parts.mailboxes;
  for (std::size_t i = 0; i < kPartsSteps.size(); ++i) {
    json["seconds"][kPartsSteps[i]] = parts.seconds[i];
    json["cpu_seconds"][kPartsSteps[i]] = parts.cpu_seconds[i];
    json["bytes_sent"][kPartsSteps[i]] = parts.bytes_sent[i];
  }
  json["seconds"]["total"] = total_seconds(parts);
  json["peak_memory_bytes"] = parts.peak_bytes;
  return json;
}

std::string table_of(const DagReport& report, const PartsReport& parts, int ranks) {
  std::string steps;
  for (std::size_t i = 0; i < kPartsSteps.size(); ++i)
    steps +=
        fmt::format("{}{} {}", i == 0 ? "" : ", ", kPartsSteps[i], human_seconds(parts.seconds[i]));
  return fmt::format(
      "{}\n"
      "  time          {}: {}\n"
      "  parts         {}, {} of them built now, by {} {}\n"
      "  peak memory   {}\n",
      dag_table(report), human_seconds(total_seconds(parts)), steps, parts.parts, parts.built,
      ranks, ranks == 1 ? "process" : "processes", human_bytes(parts.peak_bytes));
}

}  // namespace

void build_dag_in_parts(const BuildArguments& arguments, Session& session) {
  Job& process = join_job(session);
  if (arguments.work_folder.empty() && process.count() > 1)
    throw Error("several processes need --work: a folder that all of them see");
  if (process.is_first()) check_writable(arguments.output);

  MemoryBudget memory = command_budget(arguments.memory_limit);
  PartsJob job;
  job.mesh = session.subject;
  job.output = arguments.output;
  job.grid = arguments.grid;
  job.transform = arguments.access.transform;
  job.parts = arguments.parts;
  arguments.access.give_rights(job.reading);
  std::vector<std::string> warnings;
  job.reading.warnings = &warnings;
  job.present = [&](const std::filesystem::path& draft) {
    return presentation_of_file(draft, arguments.presentation(), {&memory, &session.progress});
  };
  std::optional<TemporaryFolder> temporary;
  if (arguments.work_folder.empty()) temporary.emplace(arguments.output);
  job.work_folder =
      temporary ? temporary->path() / "work" : std::filesystem::path(arguments.work_folder);
  PartsReport parts;
  try {
    parts = build_in_parts(job, written_by(), process.ranks(), {&memory, &session.progress});
  } catch (const Cancelled&) {
    if (!temporary && process.is_first())
      print_line("the work is kept in " + arguments.work_folder +
                 "; the same command again goes on with it");
    throw;
  }
  if (!process.is_first()) return;
  if (parts.bad_triangles > 0)
    warnings.push_back(bad_triangles_warning(session.subject, parts.bad_triangles));
  print_warnings(warnings, session);
  warn_of_rounding(session.subject, parts.rounding, parts.metadata.grid.voxel_size, session);

  const DagReport report = report_of_file(parts, arguments.output);
  warn_if_empty(report.metadata.counts.voxels, arguments.output, session);
  session.bar.clear();
  if (session.json) {
    fmt::print("{}", json_text(json_of(report, parts, process.count())));
  } else if (!session.quiet) {
    fmt::print("{}: {}\n{}{}", with_output_name(arguments.output), human_bytes(report.file_bytes),
               arguments.transform_line(), table_of(report, parts, process.count()));
    if (arguments.stats) fmt::print("\n{}", level_table(report.metadata.counts));
  }
}

}  // namespace voxdag::cli
