/// Prints the tables of `voxdag bench build`.
#include <fmt/core.h>

#include <algorithm>

#include "lab/build/bench_report.hpp"
#include "lab/papers/svdag_published.hpp"
#include "voxdag/file/report/human.hpp"

namespace voxdag::lab {
namespace {

using Builds = std::vector<BuildRun>;

std::string resolution(int levels) { return with_commas(std::uint64_t{1} << levels); }

std::string factor(double value) { return value > 0 ? fmt::format("{:.2f}", value) : ""; }

std::string failed(int levels, const std::string& reason) {
  return fmt::format("  {:>9}  failed: {}\n", resolution(levels), reason);
}

/// Returns a row of right-aligned cells of these widths.
std::string row(const std::vector<std::string>& cells, const std::vector<int>& widths) {
  std::string line = " ";
  for (std::size_t i = 0; i < cells.size(); ++i)
    line += fmt::format(" {:>{}}", cells[i], widths[i]);
  line.erase(line.find_last_not_of(' ') + 1);
  return line + "\n";
}

std::string build_rows(const Builds& builds, std::size_t begin, std::size_t end) {
  const std::vector<int> widths{9, 15, 12, 9, 9, 9, 9, 9, 8, 9, 6, 6};
  std::string text = row({"", "", "", "", "", "", "", "", "of its", "growth", "", ""}, widths);
  text += row({"grid", "voxels", "DAG nodes", "DAG", "wall s", "CPU s", "voxels/s", "peak mem",
               "limit", "wall", "DAG", "voxels"},
              widths);
  for (std::size_t i = begin; i < end; ++i) {
    const BuildRun& run = builds[i];
    if (!run.failure.empty()) {
      text += failed(run.levels, run.failure);
      continue;
    }
    const Growth growth = growth_to(builds, i);
    text +=
        row({resolution(run.levels), with_commas(run.voxels), with_commas(run.dag_nodes),
             human_bytes(run.dag_bytes), fmt::format("{:.2f}", run.cost.wall_seconds),
             fmt::format("{:.2f}", run.cost.cpu_seconds()), human_count(run.voxels_per_second()),
             human_bytes(run.cost.peak_bytes), fmt::format("{:.0f}%", 100 * run.memory_ratio()),
             factor(growth.wall), factor(growth.dag_bytes), factor(growth.voxels)},
            widths);
  }
  return text;
}

std::string stage_rows(const Builds& builds, std::size_t begin, std::size_t end) {
  const std::vector<int> widths{9, 9, 9, 9, 9, 9, 9, 9, 9};
  std::string text =
      row({"wall s", "read", "quantize", "voxelize", "merge", "number", "fill the", "count and",
           "start and"},
          widths) +
      row({"", "mesh", "and bin", "", "", "nodes", "inside", "write", "end"}, widths);
  for (std::size_t i = begin; i < end; ++i) {
    const BuildRun& run = builds[i];
    if (!run.failure.empty()) continue;
    std::vector<std::string> cells{resolution(run.levels)};
    for (const char* stage :
         {"read", "quantize", "voxelize", "merge", "canonical", "solid", "write"})
      cells.push_back(fmt::format("{:.2f}", run.stage(stage)));
    cells.push_back(fmt::format("{:.2f}", run.cost.wall_seconds - run.stage("total")));
    text += row(cells, widths);
  }
  return text + "\n";
}

/// Returns the table of reduction and sorting, for the paper's method with the paper's Table 1;
/// empty if the builds do not sort.
std::string sorting_rows(const Builds& builds, std::size_t begin, std::size_t end) {
  const bool is_paper = builds[begin].method == "paper";
  if (!is_paper && builds[begin].method != "sort") return "";
  const std::vector<int> widths{9, 11, 11, 11, 11};
  const PaperMatch& paper_scene = builds[begin].paper;
  std::string text =
      (is_paper
           ? fmt::format("  Wall-clock seconds of reduction: ours on {} threads; published: {}\n",
                         builds[begin].threads, published::kSource)
           : "  Seconds of reduction, summed over all threads\n") +
      (paper_scene.scene == nullptr ? "" : "  This mesh: " + paper_scene.label() + "\n") +
      row({"grid", "reduction", "sorting", is_paper ? "published" : "", is_paper ? "sorting" : ""},
          widths);
  for (std::size_t i = begin; i < end; ++i) {
    const BuildRun& run = builds[i];
    if (!run.failure.empty()) continue;
    std::vector<std::string> cells{resolution(run.levels),
                                   fmt::format("{:.3f}", run.stage("reduce")),
                                   fmt::format("{:.3f}", run.stage("sort"))};
    if (const auto paper = published::reduction_of(run.paper, run.levels); paper && is_paper) {
      cells.push_back(fmt::format("{:.4g}", paper->total));
      cells.push_back(fmt::format("{:.4g}", paper->sorting));
    }
    text += row(cells, widths);
  }
  return text + "\n";
}

std::string rival_rows(const BenchResults& results, const std::string& scene) {
  const std::vector<int> widths{9, 18, 9, 9, 9, 9, 8, 8, 8};
  const auto ours = [&](int levels) {
    return std::find_if(results.builds.begin(), results.builds.end(), [&](const BuildRun& run) {
      return run.scene == scene && run.levels == levels && run.failure.empty();
    });
  };
  std::string text;
  for (const RivalRun& run : results.rivals) {
    if (run.scene != scene) continue;
    const std::string wall = fmt::format("{:.2f}", run.build.cost.wall_seconds);
    if (!run.build.failure.empty()) {
      text += fmt::format("  {:>9} {:>18}  failed: {}\n", resolution(run.levels), run.name,
                          run.build.failure);
      continue;
    }
    std::vector<std::string> cells{resolution(run.levels),
                                   run.name,
                                   wall,
                                   fmt::format("{:.2f}", run.build.cost.cpu_seconds()),
                                   human_bytes(run.build.cost.peak_bytes),
                                   human_bytes(run.build.output_bytes)};
    if (const auto own = ours(run.levels); own != results.builds.end()) {
      cells.push_back(human_ratio(run.build.cost.wall_seconds / own->cost.wall_seconds));
      cells.push_back(human_ratio(run.build.cost.cpu_seconds() / own->cost.cpu_seconds()));
      cells.push_back(human_ratio(static_cast<double>(run.build.cost.peak_bytes) /
                                  static_cast<double>(own->cost.peak_bytes)));
    }
    text += row(cells, widths);
  }
  if (text.empty()) return "";
  return row({"", "", "", "", "", "", "times", "voxdag's", ""}, widths) +
         row({"grid", "other program", "wall s", "CPU s", "peak mem", "output", "wall", "CPU",
              "memory"},
             widths) +
         text + "\n";
}

}  // namespace

std::string bench_table(const BenchResults& results) {
  const Builds& builds = results.builds;
  std::string text;
  for (std::size_t begin = 0, end; begin < builds.size(); begin = end) {
    const BuildRun& first = builds[begin];
    end = begin;
    while (end < builds.size() && builds[end].scene == first.scene &&
           builds[end].method == first.method)
      ++end;
    text += fmt::format("{}: {} triangles, --method {}, {} threads\n", first.scene,
                        with_commas(first.triangles), first.method, first.threads);
    text += build_rows(builds, begin, end) + "\n" + stage_rows(builds, begin, end);
    text += sorting_rows(builds, begin, end);
    if (end == builds.size() || builds[end].scene != first.scene)
      text += rival_rows(results, first.scene);
  }
  return text + "of its limit: peak mem / (3 x DAG + mesh + 256 MiB); growth: factor per level\n";
}

}  // namespace voxdag::lab
