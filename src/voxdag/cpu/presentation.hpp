#pragma once
/// Chooses the presentation of a scene that is about to be saved, and shows a scene by it.
#include "voxdag/file/scene_metadata.hpp"
#include "voxdag/render/view.hpp"

namespace voxdag {

/// Returns the presentation with home_view() of the voxels. If its up axis is not known, detects
/// it and notes that it is guessed. Takes about ten milliseconds.
inline Presentation with_home(Presentation presentation, const VoxelSet& voxels, const Grid& grid) {
  presentation.is_up_guessed |= !presentation.up;
  presentation.home = home_view(voxels, grid, presentation.up_vector());
  const Vec3d up = presentation.home->up;
  presentation.up = up.x != 0 ? 'x' : up.y != 0 ? 'y' : 'z';
  return presentation;
}

/// Tells `request` the scene's up vector and home.
inline void show_as(const Presentation& presentation, ViewRequest& request) {
  request.scene_up = presentation.up_vector();
  request.home = presentation.home;
}

/// Returns whether the up vector of such a view was guessed: the request has none, and the scene's
/// input does not tell it.
inline bool is_up_guessed(const ViewRequest& request, const Presentation& presentation) {
  return !request.up && (!presentation.up || presentation.is_up_guessed);
}

}  // namespace voxdag
