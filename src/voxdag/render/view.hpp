#pragma once
/// Views: from where a picture is taken, and automatic choices of good views of a scene.
#include <optional>
#include <vector>

#include "voxdag/core/grid.hpp"
#include "voxdag/layout/voxel_set.hpp"

namespace voxdag {

/// The smallest vertical angle of view. Far below it, directions of pixels are no longer distinct.
inline constexpr double kLeastFovDegrees = 1e-6;

/// World units. The picture's vertical axis is `up` as far as the view direction allows.
struct View {
  Vec3d eye{0, 0, 1};
  Vec3d target{};
  Vec3d up{0, 1, 0};
  double vertical_fov_degrees = 40;
};

/// The parts of a view that the caller wants; frame_scene finds the rest.
struct ViewRequest {
  std::optional<Vec3d> eye, target, up;
  std::optional<double> vertical_fov_degrees;
};

/// Returns the request for just this view.
inline ViewRequest as_request(const View& view) {
  return {view.eye, view.target, view.up, view.vertical_fov_degrees};
}

/// If the caller gives eye and target, frame_scene reads the voxels no deeper than this level, to
/// guess what is up.
inline constexpr int kUpLevel = 6;

/// Returns `up`, or, for a view straight up or down, the direction that is up on a map: -z if y is
/// up, y if z is up.
Vec3d up_across(Vec3d up, Vec3d forward);

/// Returns the requested view, completed so that it shows the scene well in a picture of `aspect` =
/// width / height. The default up vector is y, or z if the scene lies or stands on that axis, or
/// up_across() of these for a view along them. The default eye is above a corner of the scene, so
/// that all voxels are in the picture, or inside of a scene that is closed and roomy like a
/// building. An empty scene gets a valid view, too. Deterministic; takes some ten milliseconds.
/// Throws Error for requests that define no view: numbers that are not finite, eye = target, an
/// angle that is not at least kLeastFovDegrees and below 180, an up vector along the view.
View frame_scene(const VoxelSet& voxels, const Grid& grid, double aspect,
                 const ViewRequest& request);

/// Returns `count` different views: first from roomy places inside of the scene with a far sight,
/// if there are any, then from outside around it. Deterministic; takes some ten milliseconds.
std::vector<View> scene_views(const VoxelSet& voxels, const Grid& grid, double aspect, int count);

}  // namespace voxdag
