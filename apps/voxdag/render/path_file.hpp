#pragma once
/// Camera paths as JSON: what `render --path` reads and `scene --path` prints.
#include <optional>
#include <string>
#include <vector>

#include "voxdag/core/vec.hpp"

namespace voxdag {

/// A view at a time; what is left out is as in the key before, or what `render` would choose.
struct PathKey {
  double time = 0;  ///< Seconds.
  Vec3d eye, target;
  std::optional<Vec3d> up;
  std::optional<double> fov_degrees;  ///< Vertical.
};

struct PathFile {
  std::vector<PathKey> keys;
  std::optional<Vec3d> sun;  ///< Towards it.
};

/// Throws Error with the byte or the key where the file is not such a path. Whether the keys make
/// a path (rising times and so on) is for CameraPath to say.
PathFile read_path_file(const std::string& path);

/// The text of such a file, one line for each key.
std::string path_json(const PathFile& path);

}  // namespace voxdag
