#include "voxdag/render/film/frame_timings.hpp"

#include <fmt/core.h>

namespace voxdag {

std::string timings_csv(const std::vector<FrameTiming>& frames) {
  std::string csv = "frame,time,render_ms,write_ms,rays,mrays_per_s\n";
  for (const FrameTiming& frame : frames)
    csv += fmt::format("{},{:.6g},{:.3f},{:.3f},{},{:.4f}\n", frame.frame, frame.time,
                       frame.render_ms, frame.write_ms, frame.rays, frame.mrays_per_second());
  return csv;
}

}  // namespace voxdag
