#pragma once
/// The exposure of a film's frames, which adapts over time as an eye does.
#include <functional>
#include <span>
#include <vector>

#include "voxdag/film/camera_path.hpp"
#include "voxdag/parallel/progress.hpp"
#include "voxdag/render/render_options.hpp"

namespace voxdag {

/// Renders a picture; `progress` may be null.
using PictureRenderer = std::function<RenderedImage(const RenderOptions&, Progress* progress)>;

/// Returns the options of a small, coarse picture of the same scene: enough to know its brightness.
RenderOptions thumbnail_options(const RenderOptions& options);

/// Returns the exposure of the frame at each of the ascending `times` (seconds): the automatic
/// exposure of a thumbnail, in the geometric mean over about a second around the frame. Every frame
/// has options.exposure if that is not 0.
std::vector<float> film_exposures(const CameraPath& path, std::span<const double> times,
                                  const RenderOptions& options, const PictureRenderer& render,
                                  Progress& progress);

/// Returns exp of the mean of `logs` with Gaussian weights around each of the ascending `times`.
/// The standard deviation is half a second. Time is linear in the frames for a fixed frame rate.
std::vector<float> smoothed_exposures(std::span<const double> times, std::span<const double> logs);

}  // namespace voxdag
