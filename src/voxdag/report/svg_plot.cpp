#include "voxdag/report/svg_plot.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "voxdag/report/human.hpp"

namespace voxdag {
namespace {

constexpr std::array<const char*, 8> kColors{"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                             "#e69f00", "#56b4e9", "#000000", "#999933"};

const char* color(std::size_t series) { return kColors[series % kColors.size()]; }

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

std::string stroke(double x0, double y0, double x1, double y1, const std::string& stroke_color) {
  return fmt::format("<path d='M{:.1f} {:.1f}L{:.1f} {:.1f}' stroke='{}' fill='none'/>\n", x0, y0,
                     x1, y1, stroke_color);
}

std::string file(double width, double height, const std::string& content) {
  return fmt::format(
             "<svg xmlns='http://www.w3.org/2000/svg' width='{:.0f}' height='{:.0f}' "
             "font-family='sans-serif' font-size='12'>\n<rect width='100%' height='100%' "
             "fill='white'/>\n",
             width, height) +
         content + "</svg>\n";
}

/// Returns a round number that divides `range` into about five to ten steps.
double round_step(double range) {
  const double power = std::pow(10, std::floor(std::log10(range / 5)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (power * factor * 10 >= range) return power * factor;
  return power * 10;
}

/// Maps values to positions along one side of a box.
class Scale {
 public:
  Scale(const PlotAxis& axis, double from, double to) : axis_(axis), from_(from), to_(to) {}

  void extend(double value) {
    lo_ = std::min(lo_, on_axis(value));
    hi_ = std::max(hi_, on_axis(value));
  }
  /// Completes the scale after the last extend(). With `round_ends`, extends both ends to ticks.
  void finish(bool round_ends) {
    step_ = axis_.is_log ? std::log(axis_.step) : axis_.step;
    if (!(hi_ > lo_)) hi_ = lo_ + (step_ > 0 ? step_ : 1);
    if (!(step_ > 0)) step_ = round_step(hi_ - lo_);
    if (!round_ends) return;
    lo_ = std::floor(lo_ / step_) * step_;
    hi_ = std::max(std::ceil(hi_ / step_) * step_, lo_ + step_);
  }
  double position(double value) const {
    return from_ + (to_ - from_) * (on_axis(value) - lo_) / (hi_ - lo_);
  }
  /// Calls body(position, text) for each tick.
  template <class Body>
  void for_each_tick(const Body& body) const {
    for (double at = std::ceil(lo_ / step_ - 1e-9) * step_ + 0.0;  // no -0
         at < hi_ + step_ * 1e-6; at += step_) {
      const double value = axis_.is_log ? std::exp(at) : at;
      body(position(value), axis_.tick(value));
    }
  }

 private:
  double on_axis(double value) const { return axis_.is_log ? std::log(value) : value; }

  const PlotAxis& axis_;
  double from_, to_;
  double lo_ = HUGE_VAL, hi_ = -HUGE_VAL, step_ = 1;
};

std::string lines_in_box(const LineDiagram& diagram, double left, double top, double width,
                         double height) {
  const double bottom = top + height, right = left + width;
  Scale x(diagram.x, left, right), y(diagram.y, bottom, top);
  if (!diagram.y.is_log) y.extend(0);
  for (const PlotLine& line : diagram.lines)
    for (const auto& point : line.points) {
      x.extend(point[0]);
      y.extend(point[1]);
    }
  x.finish(false);
  y.finish(true);
  std::string text = label(left, top - 12, "start", diagram.title);
  y.for_each_tick([&](double at, const std::string& tick) {
    text += stroke(left, at, right, at, "#dddddd");
    text += label(left - 6, at + 4, "end", tick);
  });
  x.for_each_tick([&](double at, const std::string& tick) {
    text += stroke(at, top, at, bottom, "#dddddd");
    text += label(at, bottom + 18, "middle", tick);
  });
  double legend = top + 16;
  for (const PlotLine& line : diagram.lines) {
    std::string path;
    for (const auto& point : line.points)
      path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? 'M' : 'L', x.position(point[0]),
                          y.position(point[1]));
    text += fmt::format("<path d='{}' fill='none' {}/>\n", path, line.style);
    if (line.name.empty()) continue;
    text += fmt::format("<path d='M{:.1f} {:.1f}h24' fill='none' {}/>\n", left + 10, legend - 4,
                        line.style);
    text += label(left + 40, legend, "start", line.name);
    legend += 17;
  }
  return text;
}

std::string bars_in_box(const BarDiagram& diagram, double left, double top, double width,
                        double height) {
  constexpr double kGap = 0.2;  // fraction of a group's width
  const PlotAxis axis{false, 0, diagram.tick};
  Scale y(axis, top + height, top);
  y.extend(0);
  for (const BarSeries& series : diagram.series)
    for (const double value : series.values)
      if (std::isfinite(value)) y.extend(value);
  y.finish(true);
  std::string text = label(left, top - 12, "start", diagram.title);
  y.for_each_tick([&](double at, const std::string& tick) {
    text += stroke(left, at, left + width, at, "#dddddd");
    text += label(left - 6, at + 4, "end", tick);
  });
  const double group_width = width / static_cast<double>(diagram.groups.size());
  const double bar = group_width * (1 - kGap) / static_cast<double>(diagram.series.size());
  for (std::size_t g = 0; g < diagram.groups.size(); ++g) {
    const double group_left = left + group_width * (static_cast<double>(g) + kGap / 2);
    text += label(left + group_width * (static_cast<double>(g) + 0.5), top + height + 18, "middle",
                  diagram.groups[g]);
    for (std::size_t s = 0; s < diagram.series.size(); ++s) {
      const double value = diagram.series[s].values[g];
      if (!std::isfinite(value)) continue;
      const double at = y.position(value);
      text += fmt::format(
          "<rect x='{:.1f}' y='{:.1f}' width='{:.1f}' height='{:.1f}' fill='{}'/>\n",
          group_left + bar * static_cast<double>(s), at, bar * 0.92, top + height - at, color(s));
    }
  }
  for (std::size_t s = 0; s < diagram.series.size(); ++s) {
    const double at = top + 4 + 17 * static_cast<double>(s);
    text += fmt::format("<rect x='{:.1f}' y='{:.1f}' width='12' height='12' fill='{}'/>\n",
                        left + width + 14, at, color(s));
    text += label(left + width + 32, at + 11, "start", diagram.series[s].name);
  }
  return text;
}

}  // namespace

PlotAxis resolution_axis() {
  return {false, 1,
          [](double levels) { return with_commas(std::uint64_t{1} << std::lround(levels)); }};
}

PlotAxis log_seconds_axis() {
  return {true, 10, [](double v) { return fmt::format("{:.4g} s", v); }};
}

std::string plot_style(std::size_t series, const char* more) {
  return fmt::format("stroke='{}' {}", color(series), more);
}

std::string line_svg(const std::vector<LineDiagram>& diagrams) {
  constexpr double kLeft = 80, kPitch = 560, kTop = 40, kWidth = 450, kHeight = 380;
  std::string content;
  double left = kLeft;
  for (const LineDiagram& diagram : diagrams) {
    content += lines_in_box(diagram, left, kTop, kWidth, kHeight);
    left += kPitch;
  }
  return file(kPitch * static_cast<double>(diagrams.size()), kTop + kHeight + 50, content);
}

std::string bar_svg(const std::vector<BarDiagram>& diagrams) {
  constexpr double kLeft = 80, kTop = 40, kWidth = 760, kHeight = 190, kPitch = 270;
  std::string content;
  double top = kTop;
  for (const BarDiagram& diagram : diagrams) {
    content += bars_in_box(diagram, kLeft, top, kWidth, kHeight);
    top += kPitch;
  }
  return file(kLeft + kWidth + 200, kPitch * static_cast<double>(diagrams.size()) + 10, content);
}

}  // namespace voxdag
