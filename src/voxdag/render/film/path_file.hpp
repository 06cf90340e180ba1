#pragma once
/// Camera paths as JSON: `render --path` reads them and `scene --path` prints them.
#include <optional>
#include <string>
#include <vector>

#include "voxdag/render/film/camera_path.hpp"

namespace voxdag {

/// A view at a time. Values that a key leaves out are those of the previous key.
struct PathKey {
  double time = 0;  ///< Seconds.
  Vec3d eye, target;
  std::optional<Vec3d> up;
  std::optional<double> fov_degrees;  ///< Vertical.
};

/// Returns keys with one up vector and field of view. The elements of `views` have a time in
/// seconds, an eye and a target.
template <class Views>
std::vector<PathKey> path_keys(const Views& views, Vec3d up, double fov_degrees) {
  std::vector<PathKey> keys;
  for (const auto& view : views) keys.push_back({view.time, view.eye, view.target, {}, {}});
  if (keys.empty()) return keys;
  keys.front().up = up;
  keys.front().fov_degrees = fov_degrees;
  return keys;
}

struct PathFile {
  std::string name;  ///< The file's name, for errors.
  std::vector<PathKey> keys;
  std::optional<Vec3d> sun;  ///< Direction towards the sun.
};

/// Reads at most 16 MiB of JSON. Throws Error with the byte or the key if the file is not a camera
/// path. Does not check that times increase and views are valid; make_camera_path() does.
PathFile read_path_file(const std::string& path);

/// Returns the text of a path file, one line per key.
std::string path_json(const PathFile& path);

/// Returns the camera path. `first` completes the first key; frame_scene() chooses the values that
/// are still missing, for a picture of `aspect` = width / height. Throws Error with the key.
CameraPath make_camera_path(const PathFile& file, const VoxelSet& scene, const Grid& grid,
                            double aspect, const ViewRequest& first);

}  // namespace voxdag
