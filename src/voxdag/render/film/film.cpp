#include "voxdag/render/film/film.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "voxdag/core/error.hpp"
#include "voxdag/render/film/frame_names.hpp"

namespace voxdag {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

}  // namespace

std::vector<double> frame_times(const CameraPath& path, double frames_per_second) {
  const double count = std::floor((path.end() - path.start()) * frames_per_second + 1e-6) + 1;
  if (!(count <= kMaxFrames))
    throw Error(fmt::format("the film would have {:.0f} frames; at most {:.0f} are allowed", count,
                            kMaxFrames));
  std::vector<double> times;
  times.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < static_cast<int>(count); ++i)
    times.push_back(path.start() + i / frames_per_second);
  return times;
}

double estimate_seconds(const Film& film, const PictureRenderer& render) {
  RenderOptions small = thumbnail_options(film.options);
  small.shadow_samples = film.options.shadow_samples;
  small.occlusion_samples = film.options.occlusion_samples;
  small.view = as_request(film.path.at(film.path.start()), small.view);
  const auto start = Clock::now();
  render(small, {});
  const double seconds = milliseconds_since(start) / 1000;
  const double pixels = static_cast<double>(film.options.width) * film.options.height;
  const double small_pixels = static_cast<double>(small.width) * small.height;
  const std::size_t frames = frame_times(film.path, film.frames_per_second).size();
  return static_cast<double>(frames) * seconds * std::max(pixels / small_pixels, 1.0);
}

std::vector<FrameTiming> render_film(const Film& film, const PictureRenderer& render,
                                     WorkQueue& queue, Work work) {
  const std::vector<double> times = frame_times(film.path, film.frames_per_second);
  const std::vector<float> exposures =
      film_exposures(film.path, times, film.options, render, queue, work);
  RenderOptions options = film.options;
  return results_of<FrameTiming>(queue, times.size(), [&](std::size_t i) {
    FrameTiming timing;
    timing.frame = static_cast<int>(i);
    timing.time = times[i];
    options.view = as_request(film.path.at(times[i]), options.view);
    options.exposure = exposures[i];
    auto stage = Clock::now();
    const RenderedImage image = render(options, {});
    work.poll();
    timing.render_ms = milliseconds_since(stage);
    timing.rays = image.rays;
    stage = Clock::now();
    for (const PicturePass& pass : film.passes)
      write_pass(*pass.kind, frame_name(pass.path, timing.frame), image);
    timing.write_ms = milliseconds_since(stage);
    work.report_done("frames", i + 1, times.size());
    return timing;
  });
}

std::string timings_csv(const std::vector<FrameTiming>& frames) {
  std::string csv = "frame,time,render_ms,write_ms,rays,mrays_per_s\n";
  for (const FrameTiming& frame : frames)
    csv += fmt::format("{},{:.6g},{:.3f},{:.3f},{},{:.4f}\n", frame.frame, frame.time,
                       frame.render_ms, frame.write_ms, frame.rays, frame.mrays_per_second());
  return csv;
}

}  // namespace voxdag
