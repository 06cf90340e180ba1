#pragma once
/// Cameras as matrices in JSON, for programs that reconstruct scenes or draw into the same picture.
#include <string>

#include "voxdag/render/view.hpp"

namespace voxdag {

/// Reads a camera from a JSON file of at most 1 MiB. Its members:
///   "camera_to_world" (or "transform_matrix") or "world_to_camera": rows of a 4×4 or 3×4 matrix,
///     a rotation and a translation; the first of them counts;
///   "convention": "opengl" (the default: x right, y up, looks along -z) or "opencv" (x right, y
///     down, looks along z);
///   "fov_y_degrees", or "fl_y" or "intrinsics" (rows of a 3×3 matrix of pixels) with "height".
/// Pixels must be square and the centre of projection in the middle of the picture. Other members
/// are ignored, so that this reads what camera_json() writes. Throws Error with the file's name and
/// the member.
ViewRequest read_camera_file(const std::string& path);

/// Returns the camera of a picture as JSON: both matrices, the intrinsics, and the values of the
/// options --eye, --target, --up and --fov. The convention is opengl.
std::string camera_json(const View& view, int width, int height);

}  // namespace voxdag
