#include "cli/look_input.hpp"

#include <algorithm>
#include <cmath>

#include "cli/command.hpp"
#include "voxdag/core/error.hpp"

namespace voxdag::cli {
namespace {

/// Returns whether the grids have the same cube, up to the difference of fit_grid()'s cubes at
/// different resolutions.
bool have_same_cube(const Grid& a, const Grid& b) {
  constexpr double kVoxels = 1.0 / 64;
  const double most = std::max(a.voxel_size, b.voxel_size) * kVoxels;
  const Vec3d apart = a.origin - b.origin;
  return std::abs(apart.x) <= most && std::abs(apart.y) <= most && std::abs(apart.z) <= most &&
         std::abs(a.side() - b.side()) <= most;
}

}  // namespace

Option add_look_option(const Command& command, std::string& file) {
  return command.text(
      "--look", file, "FILE",
      "The voxels of a DAG get the colours and normals of this file: an .esvo file, "
      "or a .vdag file with attributes, of the same mesh");
}

std::optional<SceneModel> open_look(const std::string& file, const SceneModel& scene,
                                    Session& session) {
  if (file.empty()) return std::nullopt;
  if (scene.voxels().esvo() != nullptr)
    throw Error("--look", "", "needs a DAG, but the scene is an ESVO, which has a look of its own");
  SceneModel look(file, &session.progress);
  if (look_of(look).is_empty())
    throw Error(file, "", "is neither an ESVO nor a DAG with attributes");
  if (!have_same_cube(look.grid(), scene.grid()))
    throw Error(file, "", "is of another mesh: its grid has another place or size than the DAG's");
  return look;
}

LookView look_of(const SceneModel& file) {
  const VoxelSet voxels = file.voxels();
  if (voxels.esvo() != nullptr) return *voxels.esvo();
  return file.colored_dag();
}

}  // namespace voxdag::cli
