#pragma once
/// Where a picture is taken from, and the views that show a scene when nobody says.
#include <optional>
#include <vector>

#include "voxdag/core/grid.hpp"
#include "voxdag/trace/voxel_scene.hpp"

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

/// Where eye and target are given, frame_scene asks the cells of this level what is up, and no
/// others.
inline constexpr int kUpLevel = 6;

/// `up`, or for a view that runs straight up or down what is ahead on a map: -z where y is up, y
/// where z is.
Vec3d up_across(Vec3d up, Vec3d forward);

/// The view that was asked for, completed so that it shows the scene well in a picture of
/// `aspect` = width / height. Without an up vector: y, or z where the scene lies or stands on that
/// axis, or across these if the view runs along them. Without an eye: from above one corner with
/// all voxels in the picture, or from inside where it is a closed box, as buildings are, with room
/// to look around. A valid view even for an empty scene. Deterministic; some ten milliseconds.
/// Throws Error for a request that names no view: numbers that are not finite, eye = target, an
/// angle that is not at least kLeastFovDegrees and below 180, up along the view.
View frame_scene(const VoxelScene& voxels, const Grid& grid, double aspect,
                 const ViewRequest& request);

/// `count` views that differ from each other: from inside, from roomy places with far to see, where
/// the scene has such, then from outside around it. Deterministic; some ten milliseconds.
std::vector<View> scene_views(const VoxelScene& voxels, const Grid& grid, double aspect, int count);

}  // namespace voxdag
