#pragma once
/// The exposure of a picture.
#include <span>

#include "voxdag/core/vec.hpp"

namespace voxdag {

/// Returns the factor that brings the geometric mean of the surfaces' brightness to a medium value,
/// or a smaller factor if more than 5% of them would become white. Pixels with infinite depth do
/// not count. The spans have one value for each pixel.
float automatic_exposure(std::span<const Vec3f> radiance, std::span<const float> depth);

}  // namespace voxdag
