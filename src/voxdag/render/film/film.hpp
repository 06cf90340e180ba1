#pragma once
/// Films: the frames along a camera path, rendered and written.
#include <cstdint>
#include <string>
#include <vector>

#include "voxdag/core/parallel/work_queue.hpp"
#include "voxdag/render/film/film_exposure.hpp"
#include "voxdag/render/film/picture_pass.hpp"

namespace voxdag {

struct FrameTiming {
  int frame = 0;
  double time = 0;       ///< Time in the film, seconds.
  double render_ms = 0;  ///< Casting and shading.
  double write_ms = 0;   ///< Encoding and writing the picture.
  std::uint64_t rays = 0;

  double mrays_per_second() const {
    return render_ms > 0 ? static_cast<double>(rays) / render_ms * 1e-3 : 0;
  }
};

/// Returns a header line and a line per frame.
std::string timings_csv(const std::vector<FrameTiming>& frames);

inline constexpr double kMaxFramesPerSecond = 1000;
inline constexpr double kMaxFrames = 1e6;

struct Film {
  CameraPath path;
  double frames_per_second = 30;    ///< At most kMaxFramesPerSecond.
  RenderOptions options;            ///< Options of each frame; the path sets the view.
  std::vector<PicturePass> passes;  ///< Passes written for each frame, to numbered files.
};

/// Returns the times of the frames, from the path's first key to its last one, in seconds. Throws
/// Error if there would be more than kMaxFrames.
std::vector<double> frame_times(const CameraPath& path, double frames_per_second);

/// Estimates the time to render the film, in seconds. Renders a thumbnail of the first frame,
/// measures the time, and multiplies by frames and pixels.
double estimate_seconds(const Film& film, const PictureRenderer& render);

/// Renders and writes all frames, which are the items of `queue`. All its processes return the
/// timings of all frames. Throws Error if a file cannot be written, and Cancelled.
std::vector<FrameTiming> render_film(const Film& film, const PictureRenderer& render,
                                     WorkQueue& queue, Work work);

}  // namespace voxdag
