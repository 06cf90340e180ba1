/// Draws the chart of `voxdag bench build --plot`.
#include <cmath>

#include "lab/build/bench_report.hpp"

namespace voxdag::lab {
namespace {

using Builds = std::vector<BuildRun>;

/// Adds a line of `value`, and a dashed one of `bound`, for each scene and method.
template <class Value, class Bound>
void add_lines(const Builds& builds, const Value& value, const Bound& bound, ChartPanel& panel) {
  int color = 0;
  for (std::size_t begin = 0, end; begin < builds.size(); begin = end, ++color) {
    const std::string method = builds[begin].method == "hash" ? "" : ", " + builds[begin].method;
    ChartLine line{builds[begin].scene + method, {}, {}, color, LineStyle::kSolid, true};
    ChartLine dashed{"", {}, {}, color, LineStyle::kDashed};
    const BuildRun* finest = nullptr;
    for (end = begin; end < builds.size() && builds[end].scene == builds[begin].scene &&
                      builds[end].method == builds[begin].method;
         ++end)
      if (builds[end].failure.empty()) finest = &builds[end];
    for (std::size_t i = begin; i < end; ++i) {
      if (!builds[i].failure.empty()) continue;
      line.x.push_back(std::ldexp(1.0, builds[i].levels));
      line.y.push_back(value(builds[i]));
      dashed.x.push_back(line.x.back());
      dashed.y.push_back(bound(builds[i], *finest));
    }
    if (line.x.empty()) continue;
    panel.lines.push_back(std::move(line));
    panel.lines.push_back(std::move(dashed));
  }
}

double seconds(const BuildRun& run) { return run.cost.wall_seconds; }
double megabytes(std::uint64_t bytes) { return static_cast<double>(bytes) * 0x1p-20; }

}  // namespace

Chart bench_chart(const BenchResults& results, const std::filesystem::path& file) {
  const ChartAxis resolution{"resolution", AxisScale::kLog2};
  ChartPanel time{"Time; dashed: growth of the DAG",
                  resolution,
                  {"seconds of the whole process", AxisScale::kLog10},
                  {},
                  {}};
  ChartPanel memory{
      "The DAG; dashed: peak memory of the build", resolution, {"MiB", AxisScale::kLog10}, {}, {}};
  add_lines(
      results.builds, seconds,
      [](const BuildRun& run, const BuildRun& finest) {
        return seconds(finest) * static_cast<double>(run.dag_bytes) /
               static_cast<double>(finest.dag_bytes);
      },
      time);
  add_lines(
      results.builds, [](const BuildRun& run) { return megabytes(run.dag_bytes); },
      [](const BuildRun& run, const BuildRun&) { return megabytes(run.cost.peak_bytes); }, memory);
  if (time.lines.empty()) throw Error("there is nothing to plot");
  return {file, {time, memory}};
}

}  // namespace voxdag::lab
