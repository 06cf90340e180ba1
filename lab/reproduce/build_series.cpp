#include "lab/reproduce/build_series.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "lab/reproduce/table_text.hpp"
#include "voxdag/file/report/human.hpp"

namespace voxdag::lab {
namespace {

using Json = nlohmann::ordered_json;

std::vector<std::string> options_of(BuildKind kind) {
  switch (kind) {
    case BuildKind::kPaper:
      return {"--method", "paper"};
    case BuildKind::kHash:
      return {"--method", "hash"};
    case BuildKind::kEsvo:
      return {"--as", "esvo"};
    case BuildKind::kShape:
      break;
  }
  return {"--as", "esvo", "--no-attributes"};
}

/// Returns why the build after `last` is not worth a try; empty if it is.
std::string reason_to_stop(const PapersPlan& plan, const SeriesRun& last, int levels) {
  if (!last.result.failure.empty())
    return fmt::format("not run, because {}³ failed: {}", 1 << last.levels, last.result.failure);
  // The seconds of reading the mesh do not grow; the others grow by four at most, as surfaces do.
  const double predicted = last.result.cost.wall_seconds * std::exp2(levels - last.levels);
  if (plan.cell_seconds > 0 && predicted > plan.cell_seconds)
    return fmt::format("not run, because {}³ took {}, and the limit is {}", 1 << last.levels,
                       human_duration(last.result.cost.wall_seconds),
                       human_duration(plan.cell_seconds));
  return "";
}

}  // namespace

Cell build_cell(const PapersPlan& plan, const FoundScene& scene, int levels,
                const std::filesystem::path& output, const std::vector<std::string>& options) {
  Cell cell;
  cell.output = output;
  cell.inputs = {scene.mesh};
  cell.arguments = {"build", scene.mesh, "-r", std::to_string(1 << levels), "-o", output, "--json"};
  cell.arguments.insert(cell.arguments.end(), options.begin(), options.end());
  if (plan.memory_bytes > 0)
    cell.arguments.insert(cell.arguments.end(), {"--memory", std::to_string(plan.memory_bytes)});
  if (plan.threads > 0)
    cell.arguments.insert(cell.arguments.end(), {"--threads", std::to_string(plan.threads)});
  return cell;
}

std::vector<SeriesRun> run_series(const PapersPlan& plan, const std::vector<int>& levels,
                                  const std::function<Cell(int levels)>& make_cell,
                                  CellStore& cells, const Progress& progress) {
  std::vector<SeriesRun> runs;
  std::string reason;
  for (const int level : levels) {
    progress.throw_if_cancelled();
    SeriesRun run{level, make_cell(level), {}};
    run.cell.seconds_limit = plan.cell_seconds;
    if (reason.empty() && !runs.empty()) reason = reason_to_stop(plan, runs.back(), level);
    if (reason.empty())
      run.result = cells.run(run.cell);
    else
      run.result.failure = reason;
    runs.push_back(std::move(run));
  }
  return runs;
}

std::vector<SeriesRun> build_series(const PapersPlan& plan, BuildKind kind, const FoundScene& scene,
                                    const std::vector<int>& levels, CellStore& cells,
                                    const Progress& progress) {
  // An ESVO's file cannot be a device.
  const bool is_esvo = kind == BuildKind::kEsvo || kind == BuildKind::kShape;
  const std::filesystem::path output = is_esvo ? plan.scratch / "build.esvo" : "/dev/null";
  std::vector<std::string> options = options_of(kind);
  if (is_esvo) options.insert(options.end(), scene.options.begin(), scene.options.end());
  const auto make_cell = [&](int level) { return build_cell(plan, scene, level, output, options); };
  std::vector<SeriesRun> runs = run_series(plan, levels, make_cell, cells, progress);
  if (is_esvo) std::filesystem::remove(output);
  return runs;
}

std::vector<int> levels_of(const std::vector<const std::vector<SeriesRun>*>& all) {
  std::set<int> levels;
  for (const std::vector<SeriesRun>* runs : all)
    for (const SeriesRun& run : *runs) levels.insert(run.levels);
  return {levels.begin(), levels.end()};
}

double value_at(const std::vector<SeriesRun>& runs, int levels,
                const std::function<double(const CellResult&)>& read) {
  for (const SeriesRun& run : runs)
    if (run.levels == levels && run.result.failure.empty()) return read(run.result);
  return NAN;
}

const SeriesRun* finest_of(const std::vector<SeriesRun>& runs) {
  const SeriesRun* finest = nullptr;
  for (const SeriesRun& run : runs)
    if (run.result.failure.empty()) finest = &run;
  return finest;
}

void add_commands(Section& section, const std::vector<SceneSeries>& all) {
  const auto first = std::find_if(all.begin(), all.end(),
                                  [](const SceneSeries& series) { return !series.runs.empty(); });
  if (first == all.end()) return;
  section.parts.emplace_back(CommandLine{command_of(first->runs.back().cell)});
  for (const SceneSeries& series : all)
    for (const SeriesRun& run : series.runs)
      if (!run.result.failure.empty()) {
        section.parts.emplace_back(
            Paragraph{fmt::format("{} at {}: {}.", series.scene.scene->name,
                                  short_resolution(run.levels), run.result.failure)});
        break;  // the finer ones have the same reason
      }
}

Json series_json(const std::vector<SeriesRun>& runs) {
  Json array = Json::array();
  for (const SeriesRun& run : runs) {
    array.push_back({{"resolution", std::int64_t{1} << run.levels},
                     {"command", command_of(run.cell)},
                     {"wall_seconds", run.result.cost.wall_seconds},
                     {"cpu_seconds", run.result.cost.cpu_seconds()},
                     {"peak_memory_bytes", run.result.cost.peak_bytes}});
    if (run.result.failure.empty())
      array.back()["result"] = run.result.json;
    else
      array.back()["failure"] = run.result.failure;
  }
  return array;
}

double typical_seconds(const PapersPlan& plan, BuildKind kind, const std::vector<int>& levels) {
  // Measured with Crytek Sponza: seconds at 2048³, and the factor from one level to the next.
  struct Cost {
    double seconds, growth;
  };
  static constexpr Cost kCosts[] = {{0.9, 3}, {0.4, 2.4}, {20, 4}, {4, 3.5}};
  const Cost& cost = kCosts[static_cast<int>(kind)];
  double sum = 0;
  for (const int level : levels) {
    const double seconds = cost.seconds * std::pow(cost.growth, level - 11);
    if (plan.cell_seconds > 0 && seconds > plan.cell_seconds) break;
    sum += seconds;
  }
  return sum;
}

}  // namespace voxdag::lab
