#pragma once
/// Views: the position and direction of a camera, and automatic choices of good views of a scene.
#include <optional>
#include <vector>

#include "voxdag/core/grid.hpp"
#include "voxdag/core/view.hpp"
#include "voxdag/stored/svdag/voxel_set.hpp"

namespace voxdag {

/// The parts of a view that the caller wants; frame_scene finds the rest.
struct ViewRequest {
  std::optional<Vec3d> eye, target, up;
  std::optional<double> vertical_fov_degrees;
  /// The scene's up vector, and its home_view(), as its file stores them; if not set, frame_scene
  /// detects them.
  std::optional<Vec3d> scene_up = {};
  std::optional<HomeView> home = {};
};

/// Returns the request for just this view of the scene that `scene` describes.
inline ViewRequest as_request(const View& view, const ViewRequest& scene = {}) {
  return {view.eye, view.target, view.up, view.vertical_fov_degrees, scene.scene_up, scene.home};
}

/// If the caller gives eye and target, frame_scene() reads the voxels only down to this level, to
/// guess the up direction.
inline constexpr int kUpLevel = 6;

/// Returns `up`. For a view straight up or down, returns the direction that is up on a map: -z if y
/// is up, y if z is up.
Vec3d up_across(Vec3d up, Vec3d forward);

/// Returns the requested view, completed so that it shows the scene well in a picture of `aspect` =
/// width / height. The default up vector is the scene's, or guess_up(), or up_across() of it for a
/// view along it. The default eye is above a corner of the scene, so that all voxels are in the
/// picture. If the scene is closed and roomy, like a building, the default eye is inside. A home
/// from outside gives the direction only. An empty scene also gets
/// a valid view. Deterministic; takes about ten milliseconds. Throws Error for requests that define
/// no view: numbers that are not finite, eye = target, a field of view below kMinFovDegrees or
/// not below 180 degrees, an up vector along the view.
View frame_scene(const VoxelSet& voxels, const Grid& grid, double aspect,
                 const ViewRequest& request);

/// Returns the default view of a scene for its file. Its coordinates are multiples of 1/1024 of the
/// grid's side, so that the file does not depend on the last bits of the computation. `up` is the
/// scene's; if not set, guess_up() chooses it. An interior gets a sun that shines through an
/// opening at surfaces in the view: see interior_sun().
HomeView home_view(const VoxelSet& voxels, const Grid& grid, const std::optional<Vec3d>& up);

/// Returns the direction towards the sun, from one of a hundred, in which most surfaces of the view
/// see the sky; the steepest of equal ones. Its components are multiples of 1/1024.
Vec3d interior_sun(const VoxelSet& voxels, const Grid& grid, const View& view, double aspect);

/// Returns whether the view is one from inside a scene whose home is inside, too.
bool shows_interior(const VoxelSet& voxels, const Grid& grid, const ViewRequest& request,
                    const View& view);

/// Returns `count` different views: first views from roomy places inside the scene from which one
/// can see far, if there are any, then views from outside, around the scene. Deterministic; takes
/// about ten milliseconds.
std::vector<View> scene_views(const VoxelSet& voxels, const Grid& grid, double aspect, int count);

}  // namespace voxdag
