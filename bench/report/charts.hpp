#pragma once
/// Charts, drawn by matplotlib (Debian's python3-matplotlib) if it is installed.
#include <filesystem>
#include <string>
#include <vector>

#include "bench/report/document.hpp"
#include "voxdag/parallel/progress.hpp"

namespace voxdag {

enum class AxisScale { kLinear, kLog2, kLog10 };

struct ChartAxis {
  std::string label;  ///< With its unit: "frame time (ms)".
  AxisScale scale = AxisScale::kLinear;
};

/// A line through points. NaN leaves a gap.
struct ChartLine {
  std::string label;  ///< Empty: not in the legend.
  std::vector<double> x, y;
  int color = 0;         ///< Lines of one colour belong together; the palette has 8.
  bool dashed = false;   ///< For published figures and for bounds.
  bool markers = false;  ///< Draw the points.
};

struct ChartPanel {
  std::string title;
  ChartAxis x, y;
  std::vector<ChartLine> lines;
};

/// Panels side by side.
struct Chart {
  std::filesystem::path file;  ///< An .svg, relative to the folder given to draw_charts().
  std::vector<ChartPanel> panels;
};

/// Draws the charts as SVG files in `folder`. The same charts give the same bytes with the same
/// version of matplotlib. Returns whether matplotlib is installed. Throws Error if it fails, and
/// Cancelled.
bool draw_charts(const std::vector<Chart>& charts, const std::filesystem::path& folder,
                 const Progress& progress);

/// Appends the charts to a section, or a note that they were not drawn.
void add_charts(Section& section, const std::vector<Chart>& charts, const std::string& caption,
                bool is_drawn);

}  // namespace voxdag
