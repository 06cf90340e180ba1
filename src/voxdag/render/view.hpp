#pragma once
/// Views: the position and direction of a camera, and automatic choices of good views of a scene.
#include <optional>
#include <vector>

#include "voxdag/core/grid.hpp"
#include "voxdag/stored/svdag/voxel_set.hpp"

namespace voxdag {

/// The smallest vertical field of view. Far below it, directions of pixels are no longer distinct.
inline constexpr double kMinFovDegrees = 1e-6;

/// A view in world units. The picture's vertical axis is `up`, made perpendicular to the view
/// direction.
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

/// If the caller gives eye and target, frame_scene() reads the voxels only down to this level, to
/// guess the up direction.
inline constexpr int kUpLevel = 6;

/// Returns `up`. For a view straight up or down, returns the direction that is up on a map: -z if y
/// is up, y if z is up.
Vec3d up_across(Vec3d up, Vec3d forward);

/// Returns the requested view, completed so that it shows the scene well in a picture of `aspect` =
/// width / height. The default up vector is guess_up(), or up_across() of it for a view along it.
/// The default eye is above a corner of the scene, so that all voxels are in the picture. If the
/// scene is closed and roomy, like a building, the default eye is inside. An empty scene also gets
/// a valid view. Deterministic; takes about ten milliseconds. Throws Error for requests that define
/// no view: numbers that are not finite, eye = target, a field of view below kMinFovDegrees or
/// not below 180 degrees, an up vector along the view.
View frame_scene(const VoxelSet& voxels, const Grid& grid, double aspect,
                 const ViewRequest& request);

/// Returns `count` different views: first views from roomy places inside the scene from which one
/// can see far, if there are any, then views from outside, around the scene. Deterministic; takes
/// about ten milliseconds.
std::vector<View> scene_views(const VoxelSet& voxels, const Grid& grid, double aspect, int count);

}  // namespace voxdag
