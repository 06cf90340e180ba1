#pragma once
/// How bright a picture is to be.
#include <span>

#include "voxdag/core/vec.hpp"

namespace voxdag {

/// The factor that gives the picture's surfaces, where depth is finite, a middling brightness on
/// geometric average, but less where that would turn more than a few of them white. One value for
/// each pixel.
float automatic_exposure(std::span<const Vec3f> radiance, std::span<const float> depth);

}  // namespace voxdag
