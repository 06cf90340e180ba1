#pragma once
/// Grids as the arguments of Python's functions.
#include <pybind11/pybind11.h>

#include <array>
#include <cstdint>
#include <optional>

#include "voxdag/builders/voxelize/grid_request.hpp"

namespace voxdag::python {

/// The lower and the upper corner of a box, in world units.
using Bounds = std::array<std::array<double, 3>, 2>;

/// Raises ValueError if there is a resolution that no grid can have.
inline std::optional<std::int64_t> checked(const std::optional<std::int64_t>& resolution) {
  if (resolution && (*resolution < 1 || *resolution > 1 << kMaxLevels))
    throw pybind11::value_error("resolution must be from 1 to 1048576");
  return resolution;
}

/// Returns the request for a grid; without resolution and pitch, as the command line. Raises
/// ValueError if both are given.
inline GridRequest grid_request(const std::optional<std::int64_t>& resolution,
                                const std::optional<double>& pitch,
                                const std::optional<Bounds>& bounds) {
  if (resolution && pitch) throw pybind11::value_error("give resolution or pitch, not both");
  if (pitch && !(*pitch > 0)) throw pybind11::value_error("pitch must be positive");
  GridRequest request;
  request.voxel_size = pitch;
  request.resolution = pitch ? std::nullopt : checked(resolution.value_or(kDefaultResolution));
  if (bounds) {
    const auto& [lo, hi] = *bounds;
    request.bounds = {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}};
  }
  return request;
}

}  // namespace voxdag::python
