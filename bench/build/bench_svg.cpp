/// Draws the plot of `voxdag bench build --plot`: two log-log diagrams.
#include <fmt/core.h>

#include <cmath>

#include "bench/build/bench_report.hpp"
#include "voxdag/report/human.hpp"
#include "voxdag/report/svg_plot.hpp"

namespace voxdag {

std::string bench_svg(const BenchResults& results) {
  const PlotAxis resolution = resolution_axis();
  LineDiagram time{"Seconds of the whole process; dashed: growth of the DAG",
                   resolution,
                   log_seconds_axis(),
                   {}};
  LineDiagram memory{
      "Bytes of the DAG; dashed: peak memory of the build",
      resolution,
      {true, 16, [](double v) { return human_bytes(static_cast<std::uint64_t>(std::llround(v))); }},
      {}};
  const std::vector<BuildRun>& builds = results.builds;
  std::size_t series = 0;
  for (std::size_t begin = 0, end; begin < builds.size(); begin = end, ++series) {
    const std::string name =
        builds[begin].scene + (builds[begin].method == "sort" ? " (sort)" : "");
    PlotLine seconds{name, plot_style(series), {}};
    PlotLine growth{"", plot_style(series, "stroke-dasharray='3 4'"), {}};
    PlotLine dag = seconds, peak = growth;
    for (end = begin; end < builds.size() && builds[end].scene == builds[begin].scene &&
                      builds[end].method == builds[begin].method;
         ++end) {
      const BuildRun& run = builds[end];
      if (!run.failure.empty()) continue;
      const double x = run.levels, size = static_cast<double>(run.dag_bytes);
      seconds.points.push_back({x, run.cost.wall_seconds});
      dag.points.push_back({x, size});
      peak.points.push_back({x, static_cast<double>(run.cost.peak_bytes)});
      growth.points.push_back({x, size});
    }
    if (seconds.points.empty()) continue;
    // Draws the growth of the DAG as a reference slope through the time at the highest resolution.
    const double seconds_per_byte = seconds.points.back()[1] / dag.points.back()[1];
    for (auto& point : growth.points) point[1] *= seconds_per_byte;
    time.lines.insert(time.lines.end(), {seconds, growth});
    memory.lines.insert(memory.lines.end(), {dag, peak});
  }
  if (time.lines.empty()) throw Error("there is nothing to plot");
  return line_svg({time, memory});
}

}  // namespace voxdag
