#pragma once
/// Diagrams as SVG: lines over an axis, and groups of bars.
#include <array>
#include <functional>
#include <string>
#include <vector>

namespace voxdag {

/// How values become a scale with ticks.
struct PlotAxis {
  bool is_log = false;
  double step = 0;  ///< Between ticks: a factor if is_log, else a difference; 0: about ten ticks.
  std::function<std::string(double value)> tick;
};

/// Of the log2 of resolutions: "1,024".
PlotAxis resolution_axis();
/// By powers of ten: "10 s".
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

/// SVG attributes that tell series of lines apart.
std::string plot_style(std::size_t series, const char* more = "stroke-width='2'");

/// A file with the diagrams beside each other.
std::string line_svg(const std::vector<LineDiagram>& diagrams);

struct BarSeries {
  std::string name;
  std::vector<double> values;  ///< One for each group; NaN for none.
};

/// Groups of bars, one bar of each series in each group, from 0 up.
struct BarDiagram {
  std::string title;
  std::function<std::string(double value)> tick;
  std::vector<std::string> groups;
  std::vector<BarSeries> series;
};

/// A file with the diagrams below each other.
std::string bar_svg(const std::vector<BarDiagram>& diagrams);

}  // namespace voxdag
