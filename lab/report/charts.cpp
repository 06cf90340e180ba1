#include "lab/report/charts.hpp"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "charts_py.hpp"
#include "lab/report/bench_child.hpp"
#include "lab/report/scratch_folder.hpp"
#include "voxdag/core/error.hpp"
#include "voxdag/core/io/atomic_file.hpp"
#include "voxdag/core/io/open_input.hpp"

namespace voxdag::lab {
namespace {

using Json = nlohmann::ordered_json;

Json axis_json(const ChartAxis& axis) {
  static constexpr const char* kScales[] = {"linear", "log2", "log10"};
  return {{"label", axis.label},
          {"scale", kScales[static_cast<int>(axis.scale)]},
          {"from_zero", axis.from_zero}};
}

Json line_json(const ChartLine& line) {
  static constexpr const char* kStyles[] = {"solid", "dashed", "dotted"};
  return {{"label", line.label},
          {"x", line.x},
          {"y", line.y},  // NaN becomes null
          {"color", line.color},
          {"style", kStyles[static_cast<int>(line.style)]},
          {"markers", line.markers}};
}

Json chart_json(const Chart& chart) {
  Json panels = Json::array();
  for (const ChartPanel& panel : chart.panels) {
    Json lines = Json::array();
    for (const ChartLine& line : panel.lines) lines.push_back(line_json(line));
    panels.push_back({{"title", panel.title},
                      {"x", axis_json(panel.x)},
                      {"y", axis_json(panel.y)},
                      {"lines", std::move(lines)},
                      {"groups", panel.groups}});
  }
  return {{"panels", panels}};
}

constexpr SizeLimit kChartLimit{std::uint64_t{1} << 28, "charts"};

/// Returns a Python interpreter that has matplotlib; empty if there is none.
std::string python_with_matplotlib(const Progress& progress) {
  // Debian's packages belong to /usr/bin/python3, which may not be the first in PATH.
  for (const char* python : {"python3", "/usr/bin/python3"})
    if (run_child({python, "-c", "import matplotlib"}, "/", 60, progress).status == 0)
      return python;
  return "";
}

}  // namespace

bool can_draw_charts(const Progress& progress) { return !python_with_matplotlib(progress).empty(); }

bool draw_charts(const std::vector<Chart>& charts, const std::filesystem::path& folder,
                 const Progress& progress) {
  const std::string python = python_with_matplotlib(progress);
  if (python.empty()) return false;
  Json all = Json::array();
  for (const Chart& chart : charts) all.push_back(chart_json(chart));
  const ScratchFolder scratch;
  write_whole_file(scratch.path() / "charts.py", kChartsPy);
  write_whole_file(scratch.path() / "charts.json", all.dump());
  const ChildResult drawn =
      run_child({python, "charts.py", "charts.json"}, scratch.path(), 0, progress);
  if (drawn.status != 0) {
    // Python prints the reason last.
    const std::string error = drawn.err.substr(0, drawn.err.find_last_not_of('\n') + 1);
    throw Error(folder, "", "matplotlib failed: " + error.substr(error.rfind('\n') + 1));
  }
  for (std::size_t i = 0; i < charts.size(); ++i)
    write_whole_file(folder / charts[i].file,
                     read_input(scratch.path() / fmt::format("{}.svg", i), kChartLimit));
  return true;
}

void add_charts(Section& section, const std::vector<Chart>& charts, const std::string& caption,
                bool is_drawn) {
  for (const Chart& chart : charts)
    if (is_drawn)
      section.parts.emplace_back(Picture{caption, chart.file});
    else
      section.parts.emplace_back(
          Paragraph{"No chart was drawn, because matplotlib (python3-matplotlib) is not installed. "
                    "report.json has its points."});
}

}  // namespace voxdag::lab
