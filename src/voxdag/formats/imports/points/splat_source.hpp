#pragma once
/// The base class of the sources of compressed Gaussian splats, and their rotations.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "voxdag/formats/imports/voxel_source.hpp"

namespace voxdag {

/// Splats with colours, or their centres as points.
class SplatSource : public VoxelSource {
 public:
  bool has_points() const final { return true; }
  bool has_colors() const final { return true; }
  bool has_splats() const final { return has_splats_; }
  CoordinateError coordinate_error() const final { return kFloatCoordinates; }

 protected:
  explicit SplatSource(bool splats_are_points) : has_splats_(!splats_are_points) {}

 private:
  bool has_splats_;
};

/// Returns a unit quaternion whose part `greatest` is left out and not negative. `parts` are the
/// others in their order.
inline std::array<float, 4> rotation_of_three(const double (&parts)[3], std::size_t greatest) {
  std::array<float, 4> rotation{};
  double left = 1;
  std::size_t next = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (i == greatest) continue;
    const double part = parts[next++];
    rotation[i] = static_cast<float>(part);
    left -= part * part;
  }
  rotation[greatest] = static_cast<float>(std::sqrt(std::max(left, 0.0)));
  return rotation;
}

}  // namespace voxdag
