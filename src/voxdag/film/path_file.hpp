#pragma once
/// Camera paths as JSON: `render --path` reads them and `scene --path` prints them.
#include <optional>
#include <string>
#include <vector>

#include "voxdag/film/camera_path.hpp"

namespace voxdag {

/// A view at a time. What a key leaves out is as in the key before.
struct PathKey {
  double time = 0;  ///< Seconds.
  Vec3d eye, target;
  std::optional<Vec3d> up;
  std::optional<double> fov_degrees;  ///< Vertical.
};

struct PathFile {
  std::string name;  ///< Of the file, for errors.
  std::vector<PathKey> keys;
  std::optional<Vec3d> sun;  ///< Direction towards it.
};

/// Reads at most 16 MiB of JSON. Throws Error with the byte or the key if the file is not a camera
/// path. Whether times rise and views are valid is for make_camera_path() to say.
PathFile read_path_file(const std::string& path);

/// Returns the text of a path file, one line per key.
std::string path_json(const PathFile& path);

/// Returns the camera path. `first` completes the first key; frame_scene finds the rest for a
/// picture of `aspect` = width / height. Throws Error with the key.
CameraPath make_camera_path(const PathFile& file, const VoxelSet& scene, const Grid& grid,
                            double aspect, const ViewRequest& first);

}  // namespace voxdag
