#pragma once
/// Films: the frames along a camera path, rendered and written.
#include <vector>

#include "voxdag/core/parallel/work_queue.hpp"
#include "voxdag/render/film/film_exposure.hpp"
#include "voxdag/render/film/frame_timings.hpp"
#include "voxdag/render/film/picture_pass.hpp"

namespace voxdag {

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
