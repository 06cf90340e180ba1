#pragma once
/// A moving camera: views at given times, and smooth motion between them.
#include <vector>

#include "voxdag/render/view.hpp"

namespace voxdag {

struct CameraKey {
  double time = 0;  ///< Seconds.
  View view;
};

/// Passes through every key at its time. Eye and target run along centripetal Catmull-Rom curves,
/// which have neither cusps nor loops between keys; how far along them the camera is, and the up
/// vector and the angle of view, are monotone cubics of time, so that nothing jumps or overshoots
/// and speeds are continuous.
class CameraPath {
 public:
  /// Throws Error unless there is a key, times increase, numbers are finite, angles of view are in
  /// (0,180) and eye and target differ.
  explicit CameraPath(std::vector<CameraKey> keys);

  double start() const { return keys_.front().time; }
  double end() const { return keys_.back().time; }
  /// Returns the view; before the first key and after the last one it is theirs.
  View at(double time) const;

 private:
  std::vector<CameraKey> keys_;
};

}  // namespace voxdag
