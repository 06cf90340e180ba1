#pragma once
/// `voxdag render --path`: the frames of a film.
#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "cli/output_files.hpp"
#include "cli/session.hpp"
#include "render/render_passes.hpp"
#include "voxdag/core/grid.hpp"
#include "voxdag/layout/voxel_set.hpp"
#include "voxdag/render/render_options.hpp"

namespace voxdag {

struct PathArguments {
  std::string file;     ///< The camera path, or empty: one picture.
  std::string timings;  ///< A CSV to write, and an SVG beside it, or empty.
  double fps = 30;
};

/// The command has --eye and --target already, which a path replaces.
void add_path_options(CLI::App& command, PathArguments& arguments);

/// Throws CLI::ValidationError where the name of an option's output has no place for a frame's
/// number and there is a path, or has one and there is none.
void check_frame_pattern(const OutputFile& output, const PathArguments& arguments);

/// The drawing beside the CSV of --timings.
std::string timings_plot(const std::string& csv);

/// How a frame is made and saved.
struct FrameMaker {
  /// The picture of these options; `progress` may be null.
  std::function<RenderedImage(const RenderOptions&, Progress*)> render;
  std::vector<RenderPass> passes;  ///< What is written of it; paths are patterns.
  /// What is up, where nobody says. Without it, the scene is asked.
  std::function<Vec3d()> find_up;
};

/// Renders the path's frames, from its first key to its last one. The sun stands still: where
/// neither options nor path place it, it is where the first frame would have it. Exposure follows
/// the frames smoothly. Throws Error for a path that is none.
void render_path(const VoxelSet& scene, const Grid& grid, const RenderOptions& options,
                 const PathArguments& arguments, const FrameMaker& maker, Session& session);

}  // namespace voxdag
