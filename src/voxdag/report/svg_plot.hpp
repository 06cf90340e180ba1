#pragma once
/// Draws diagrams as SVG: line diagrams, and groups of bars.
#include <array>
#include <functional>
#include <string>
#include <vector>

namespace voxdag {

/// The scale of an axis and its ticks.
struct PlotAxis {
  bool is_log = false;
  double step = 0;  ///< Between ticks: a factor if is_log, else a difference; 0: about ten ticks.
  std::function<std::string(double value)> tick;
};

/// Returns an axis for the log2 of resolutions, with ticks such as "1,024".
PlotAxis resolution_axis();
/// Returns a logarithmic axis for seconds, with ticks at powers of ten: "10 s".
PlotAxis log_seconds_axis();

struct PlotLine {
  std::string name;  ///< Name in the legend, or empty.
  std::string style;
  std::vector<std::array<double, 2>> points;  ///< x and y; positive on logarithmic axes.
};

struct LineDiagram {
  std::string title;
  PlotAxis x, y;
  std::vector<PlotLine> lines;
};

/// Returns SVG attributes (colour, dashes) that distinguish the lines of different series.
std::string plot_style(std::size_t series, const char* more = "stroke-width='2'");

/// Returns an SVG file with the diagrams side by side.
std::string line_svg(const std::vector<LineDiagram>& diagrams);

struct BarSeries {
  std::string name;
  std::vector<double> values;  ///< One for each group; NaN for none.
};

/// Groups of bars: each group has one bar of each series. Values must not be negative.
struct BarDiagram {
  std::string title;
  std::function<std::string(double value)> tick;
  std::vector<std::string> groups;
  std::vector<BarSeries> series;
};

/// Returns an SVG file with the diagrams one below the other.
std::string bar_svg(const std::vector<BarDiagram>& diagrams);

}  // namespace voxdag
