#pragma once
/// The exposure of a film's frames. It adapts over time, like an eye.
#include <functional>
#include <span>
#include <vector>

#include "voxdag/core/parallel/work.hpp"
#include "voxdag/core/parallel/work_queue.hpp"
#include "voxdag/render/film/camera_path.hpp"
#include "voxdag/render/render_options.hpp"

namespace voxdag {

/// Renders a picture.
using PictureRenderer = std::function<RenderedImage(const RenderOptions&, Work work)>;

/// Returns the options of a small, coarse picture of the scene, which is enough to measure its
/// brightness.
RenderOptions thumbnail_options(const RenderOptions& options);

/// Returns the exposures of the frames at the ascending `times` (seconds). An exposure is the
/// geometric mean of the automatic exposures of thumbnails over about a second around the frame. If
/// options.exposure is not 0, every frame has that exposure. The thumbnails are the items of
/// `queue`, whose processes all return all exposures.
std::vector<float> film_exposures(const CameraPath& path, std::span<const double> times,
                                  const RenderOptions& options, const PictureRenderer& render,
                                  WorkQueue& queue, Work work);

/// Returns exp of the mean of `logs` with Gaussian weights around each of the ascending `times`.
/// The standard deviation is half a second. Time is linear in the frames for a fixed frame rate.
std::vector<float> smoothed_exposures(std::span<const double> times, std::span<const double> logs);

}  // namespace voxdag
