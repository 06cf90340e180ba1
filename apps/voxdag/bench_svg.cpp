/// The picture that `voxdag bench build --plot` writes: two log-log diagrams.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "bench_report.hpp"
#include "human.hpp"

namespace voxdag {
namespace {

constexpr std::array<const char*, 8> kColors{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                             "#e69f00", "#56b4e9", "#000000", "#999933"};

struct Line {
  std::string name;  ///< In the legend, or empty.
  std::string style;
  std::vector<std::array<double, 2>> points;  ///< Levels, and a value above zero.
};

struct Diagram {
  std::string title;
  std::string (*tick)(double value);
  double step;  ///< Factor between lines of the grid.
  std::vector<Line> lines;
};

std::string escaped(const std::string& text) {
  std::string xml;
  for (const char c : text) {
    if (c == '<')
      xml += "&lt;";
    else if (c == '&')
      xml += "&amp;";
    else
      xml += c;
  }
  return xml;
}

std::string label(double x, double y, const std::string& anchor, const std::string& text) {
  return fmt::format("<text x='{:.1f}' y='{:.1f}' text-anchor='{}'>{}</text>\n", x, y, anchor,
                     escaped(text));
}

std::string stroke(double x0, double y0, double x1, double y1, const std::string& color) {
  return fmt::format("<path d='M{:.1f} {:.1f}L{:.1f} {:.1f}' stroke='{}' fill='none'/>\n", x0, y0,
                     x1, y1, color);
}

/// Draws one diagram into the box of the given corner and size.
class Plotter {
 public:
  Plotter(const Diagram& diagram, double left, double top, double width, double height)
      : diagram_(diagram), left_(left), top_(top), width_(width), height_(height) {
    for (const Line& line : diagram.lines)
      for (const auto& [x, y] : line.points) {
        x_lo_ = std::min(x_lo_, x);
        x_hi_ = std::max(x_hi_, x);
        y_lo_ = std::min(y_lo_, std::log(y));
        y_hi_ = std::max(y_hi_, std::log(y));
      }
    const double step = std::log(diagram.step);
    y_lo_ = std::floor(y_lo_ / step) * step;
    y_hi_ = std::max(std::ceil(y_hi_ / step) * step, y_lo_ + step);
    x_hi_ = std::max(x_hi_, x_lo_ + 1);
  }

  std::string svg() const {
    std::string text = label(left_, top_ - 12, "start", diagram_.title);
    const double bottom = top_ + height_, right = left_ + width_;
    for (double y = y_lo_; y < y_hi_ + 1e-9; y += std::log(diagram_.step)) {
      text += stroke(left_, y_of(y), right, y_of(y), "#dddddd");
      text += label(left_ - 6, y_of(y) + 4, "end", diagram_.tick(std::exp(y)));
    }
    for (double x = x_lo_; x < x_hi_ + 0.5; ++x) {
      text += stroke(x_of(x), top_, x_of(x), bottom, "#dddddd");
      text +=
          label(x_of(x), bottom + 18, "middle", with_commas(std::uint64_t{1} << std::lround(x)));
    }
    double legend = top_ + 16;
    for (const Line& line : diagram_.lines) {
      std::string path;
      for (const auto& [x, y] : line.points)
        path +=
            fmt::format("{}{:.1f} {:.1f}", path.empty() ? 'M' : 'L', x_of(x), y_of(std::log(y)));
      text += fmt::format("<path d='{}' fill='none' {}/>\n", path, line.style);
      if (line.name.empty()) continue;
      text += fmt::format("<path d='M{:.1f} {:.1f}h24' fill='none' {}/>\n", left_ + 10, legend - 4,
                          line.style);
      text += label(left_ + 40, legend, "start", line.name);
      legend += 17;
    }
    return text;
  }

 private:
  double x_of(double x) const { return left_ + width_ * (x - x_lo_) / (x_hi_ - x_lo_); }
  double y_of(double y) const { return top_ + height_ * (1 - (y - y_lo_) / (y_hi_ - y_lo_)); }

  const Diagram& diagram_;
  double left_, top_, width_, height_;
  double x_lo_ = 1e9, x_hi_ = -1e9, y_lo_ = 1e9, y_hi_ = -1e9;
};

std::string style(std::size_t series, const char* more = "stroke-width='2'") {
  return fmt::format("stroke='{}' {}", kColors[series % kColors.size()], more);
}

}  // namespace

std::string bench_svg(const BenchResults& results) {
  Diagram time{"Seconds, all included; dashes: growth of the DAG",
               [](double v) { return fmt::format("{:.4g} s", v); },
               10,
               {}};
  Diagram memory{"Bytes of the DAG; dashes: peak memory of the build",
                 [](double v) { return human_bytes(static_cast<std::uint64_t>(std::llround(v))); },
                 16,
                 {}};
  const std::vector<BuildRun>& builds = results.builds;
  std::size_t series = 0;
  for (std::size_t begin = 0, end; begin < builds.size(); begin = end, ++series) {
    Line seconds{
        builds[begin].scene + (builds[begin].method == "sort" ? " (sort)" : ""), style(series), {}};
    Line growth{"", style(series, "stroke-dasharray='3 4'"), {}}, dag = seconds, peak = growth;
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
    // The DAG's growth as a slope to compare with: through the greatest resolution's time.
    const double seconds_per_byte = seconds.points.back()[1] / dag.points.back()[1];
    for (auto& point : growth.points) point[1] *= seconds_per_byte;
    time.lines.insert(time.lines.end(), {seconds, growth});
    memory.lines.insert(memory.lines.end(), {dag, peak});
  }
  if (time.lines.empty()) throw Error("there is nothing to plot");
  return "<svg xmlns='http://www.w3.org/2000/svg' width='1120' height='470' "
         "font-family='sans-serif' font-size='12'>\n<rect width='100%' height='100%' "
         "fill='white'/>\n" +
         Plotter(time, 80, 40, 450, 380).svg() + Plotter(memory, 640, 40, 450, 380).svg() +
         "</svg>\n";
}

}  // namespace voxdag
