#pragma once
/// `voxdag render --path`: the frames of a film.
#include <functional>

#include "render/render_arguments.hpp"
#include "voxdag/render/film/film.hpp"

namespace voxdag::cli {

/// The scene of a film, and the function that renders its frames.
struct FilmScene {
  const VoxelSet& voxels;
  const Grid& grid;
  PictureRenderer render;
  /// Returns the up direction of the scene. If empty, frame_scene() finds it.
  std::function<Vec3d()> find_up;
};

/// Renders and writes the frames from the path's first key to its last one, and prints a summary.
/// The ranks of session.job share the frames. The sun does not move: if neither options nor path
/// set its direction, all frames use the first frame's. Throws Error if the path is wrong, or if
/// two frames would have the same name.
void render_film(const RenderArguments& arguments, const FilmScene& scene,
                 const RenderOptions& options, Session& session);

}  // namespace voxdag::cli
