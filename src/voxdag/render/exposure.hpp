#pragma once
/// The exposure of a picture.
#include <span>

#include "voxdag/core/vec.hpp"

namespace voxdag {

/// The numbers of automatic_exposure().
struct ExposureRule {
  static constexpr double kMiddle =
      0.22;  ///< The surfaces' geometric mean: the neutral curve shows it as 0.18.
  static constexpr double kBright = 0.95;  ///< This part of the surfaces may not become white.
  static constexpr double kWhite = 1.1;    ///< The brightness from which a surface is white.
  static constexpr double kMin = 1e-6;     ///< Darker pixels count as this bright in the mean.
  static constexpr double kMost = 64;      ///< Dark scenes stay dark from here on.
  /// The sky behind the surfaces has an exposure of its own, so that it is never burnt out.
  static constexpr float kSky = 0.7f;
  static constexpr float kOfNothing = 0.5f;  ///< The factor of a picture without surfaces.
  static constexpr Vec3f kLuminance{0.2126f, 0.7152f, 0.0722f};  ///< Brightness of R, G and B.
};

/// Returns the factor that brings the geometric mean of the surfaces' brightness to a medium value,
/// or a smaller factor if more than 5% of them would become white, at most kMost. Pixels with
/// infinite depth do not count. The spans have one value for each pixel.
float automatic_exposure(std::span<const Vec3f> radiance, std::span<const float> depth);

}  // namespace voxdag
