#pragma once
/// Charts, drawn by matplotlib (Debian's python3-matplotlib) if it is installed.
#include <filesystem>
#include <string>
#include <vector>

#include "lab/report/document.hpp"
#include "voxdag/core/parallel/progress.hpp"

namespace voxdag::lab {

enum class AxisScale { kLinear, kLog2, kLog10 };

struct ChartAxis {
  std::string label;  ///< With its unit: "frame time (ms)".
  AxisScale scale = AxisScale::kLinear;
  bool from_zero = true;  ///< A linear y axis begins at 0.
};

enum class LineStyle {
  kSolid,
  kDashed,  ///< For published figures and for bounds.
  kDotted,
};

/// A line through points. NaN leaves a gap.
struct ChartLine {
  std::string label;  ///< Empty: not in the legend.
  std::vector<double> x, y;
  int color = 0;  ///< Lines of one colour belong together; the palette has 8.
  LineStyle style = LineStyle::kSolid;
  bool markers = false;  ///< Draw the points.
};

struct ChartPanel {
  std::string title;
  ChartAxis x, y;
  std::vector<ChartLine> lines = {};
  /// Not empty: a group of bars for each name. Each line then has a y for each group, and no x.
  std::vector<std::string> groups = {};
};

/// Panels side by side.
struct Chart {
  std::filesystem::path file;  ///< Relative paths start in the folder given to draw_charts().
  std::vector<ChartPanel> panels;
};

/// Returns whether matplotlib is installed. Throws Cancelled.
bool can_draw_charts(const Progress& progress);

/// Draws the charts as SVG files in `folder`. The same charts give the same bytes with the same
/// version of matplotlib. Returns whether matplotlib is installed. Throws Error if it fails, and
/// Cancelled.
bool draw_charts(const std::vector<Chart>& charts, const std::filesystem::path& folder,
                 const Progress& progress);

/// Appends the charts to a section, or a note that they were not drawn.
void add_charts(Section& section, const std::vector<Chart>& charts, const std::string& caption,
                bool is_drawn);

}  // namespace voxdag::lab
