#include "voxdag/film/frame_timings.hpp"

#include <fmt/core.h>

#include "voxdag/report/svg_plot.hpp"

namespace voxdag {

std::string timings_csv(const std::vector<FrameTiming>& frames) {
  std::string csv = "frame,time,render_ms,write_ms,rays,mrays_per_s\n";
  for (const FrameTiming& frame : frames)
    csv += fmt::format("{},{:.6g},{:.3f},{:.3f},{},{:.4f}\n", frame.frame, frame.time,
                       frame.render_ms, frame.write_ms, frame.rays, frame.mrays_per_second());
  return csv;
}

std::string timings_svg(const std::vector<FrameTiming>& frames) {
  const PlotAxis seconds{false, 0, [](double v) { return fmt::format("{:.4g} s", v); }};
  const PlotAxis plain{false, 0, [](double v) { return fmt::format("{:.4g}", v); }};
  PlotLine render{"", plot_style(0), {}}, rate{"", plot_style(1), {}};
  for (const FrameTiming& frame : frames) {
    render.points.push_back({frame.time, frame.render_ms});
    rate.points.push_back({frame.time, frame.mrays_per_second()});
  }
  return line_svg({{"Milliseconds for each frame", seconds, plain, {render}},
                   {"Million rays per second", seconds, plain, {rate}}});
}

}  // namespace voxdag
