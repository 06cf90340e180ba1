#pragma once
/// A pinhole camera.
#include <cmath>

#include "voxdag/render/basis.hpp"
#include "voxdag/render/view.hpp"

namespace voxdag {

/// Maps pixels to rays. In double, because at 131,072³ a float eye would be off by voxels.
struct Camera {
  Vec3d eye;
  Vec3d forward;  ///< Unit length.
  Vec3d right;    ///< Half the picture's width at depth 1, in world units.
  Vec3d up;       ///< Half the picture's height at depth 1, in world units.
  int width = 1, height = 1;

  /// Returns the direction through the point (x,y) of the picture, in pixels from its top left
  /// corner. Its component along `forward` is 1, so that a ray's t is its depth.
  VOXDAG_HD Vec3d direction(double x, double y) const {
    return forward + right * (2 * x / width - 1) + up * (1 - 2 * y / height);
  }
  /// Returns the width of a pixel at depth 1, in world units.
  VOXDAG_HD double pixel_size() const { return 2 * std::sqrt(dot(up, up)) / height; }
};

/// Returns the camera of a view, which must be valid (see frame_scene), for a picture of this size
/// in pixels.
VOXDAG_HD inline Camera make_camera(const View& view, int width, int height) {
  constexpr double kRadiansPerDegree = 0.017453292519943295;
  Camera camera;
  camera.eye = view.eye;
  camera.width = width;
  camera.height = height;
  camera.forward = normalized(view.target - view.eye);
  const Vec3d right = normalized(cross(camera.forward, view.up));
  const double half_height = std::tan(view.vertical_fov_degrees * kRadiansPerDegree / 2);
  camera.up = cross(right, camera.forward) * half_height;
  camera.right = right * (half_height * width / height);
  return camera;
}

}  // namespace voxdag
