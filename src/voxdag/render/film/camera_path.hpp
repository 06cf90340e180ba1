#pragma once
/// A moving camera: views at given times, and smooth motion between them.
#include <vector>

#include "voxdag/render/view.hpp"

namespace voxdag {

struct CameraKey {
  double time = 0;  ///< Seconds.
  View view;
};

/// Passes through every key at its time. Eye and target move along centripetal Catmull-Rom curves,
/// which have neither cusps nor loops between keys. The position along the curve, the up vector and
/// the field of view are monotone cubics of time. So nothing jumps or overshoots, and speeds are
/// continuous.
class CameraPath {
 public:
  /// Throws Error unless there is a key, times increase, numbers are finite, fields of view are in
  /// (0,180) degrees, and eye and target differ.
  explicit CameraPath(std::vector<CameraKey> keys);

  /// Returns the time of the first key, in seconds.
  double start() const { return keys_.front().time; }
  /// Returns the time of the last key, in seconds.
  double end() const { return keys_.back().time; }
  /// Returns the view at a time in seconds. Before the first key it is that key's view, after the
  /// last key the last one's.
  View at(double time) const;

 private:
  std::vector<CameraKey> keys_;
};

}  // namespace voxdag
