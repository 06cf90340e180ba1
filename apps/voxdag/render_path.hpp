#pragma once
/// `voxdag render --path`: the frames of a film.
#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "session.hpp"
#include "voxdag/core/grid.hpp"
#include "voxdag/render/render_options.hpp"
#include "voxdag/trace/voxel_scene.hpp"

namespace voxdag {

struct PathArguments {
  std::string file;     ///< The camera path, or empty: one picture.
  std::string timings;  ///< A CSV to write, and an SVG beside it, or empty.
  double fps = 30;
};

void add_path_options(CLI::App& command, PathArguments& arguments);

/// Throws CLI::ValidationError for a name of an output that has no place for a frame's number.
void check_frame_pattern(const std::string& path);

/// How a frame is made and saved.
struct FrameMaker {
  /// The picture of these options; `progress` may be null.
  std::function<RenderedImage(const RenderOptions&, Progress*)> render;
  std::function<void(const RenderedImage&, int frame)> write;
};

/// Renders the path's frames, from its first key to its last one. The sun stands still: where
/// neither options nor path place it, it is where the first frame would have it. Exposure follows
/// the frames smoothly. Throws Error for a path that is none.
void render_path(const VoxelScene& scene, const Grid& grid, const RenderOptions& options,
                 const PathArguments& arguments, const FrameMaker& maker, Session& session);

}  // namespace voxdag
