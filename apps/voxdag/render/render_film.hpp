#pragma once
/// `voxdag render --path`: the frames of a film.
#include <functional>

#include "render/render_arguments.hpp"
#include "voxdag/film/film.hpp"

namespace voxdag {

/// The scene of a film, and how its frames are rendered.
struct FilmScene {
  const VoxelSet& voxels;
  const Grid& grid;
  PictureRenderer render;
  /// Returns the up direction of the scene; empty: frame_scene finds it.
  std::function<Vec3d()> find_up;
};

/// Renders and writes the frames from the path's first key to its last one, and prints a summary.
/// The sun stands still: if neither options nor path have its direction, the first frame's counts.
/// Throws Error if the path is wrong, or if two frames would have one name.
void render_film(const RenderArguments& arguments, const FilmScene& scene,
                 const RenderOptions& options, Session& session);

}  // namespace voxdag
