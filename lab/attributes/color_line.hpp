#pragma once
/// Colors on the line between two end points, as Dolonius and others fit and store them.
///
/// Dan Dolonius, Erik Sintorn, Viktor Kämpe and Ulf Assarsson: Compressing Color Data for Voxelized
/// Surface Geometry, I3D 2017.
#include <cstdint>
#include <span>

#include "voxdag/core/vec.hpp"

namespace voxdag::lab {

/// A color of sRGB bytes: red in bits 0-7, green in bits 8-15, blue in bits 16-23.
using ColorBytes = std::uint32_t;

Vec3f color_of_bytes(ColorBytes bytes);  ///< Each channel in [0,1].
ColorBytes bytes_of_color(Vec3f color);  ///< Rounds; clamps each channel to [0,1].

/// The largest number of bits of a weight.
inline constexpr int kMaxWeightBits = 4;

/// End points as they are stored, and the colors between them.
struct ColorLine {
  Vec3f a, b;
  /// Weights of this many bits choose the color. 0: there is one color, a.
  int weight_bits = 0;

  Vec3f color(int weight) const;
  /// Returns the weight whose color has the smallest error, near the projection of `color`.
  int weight_of(Vec3f color) const;
};

/// Fits a line to colors. With weights of 0 bits it is their mean, in 10, 12 and 10 bits. Else the
/// end points have 5, 6 and 5 bits: those of one or two colors are the colors, and those of more
/// are the ends of their projections on the principal axis through their mean.
ColorLine fit_line(std::span<const Vec3f> colors, int weight_bits);

/// Returns the distance of two colors after both are rounded to bytes; channels are in [0,1].
float color_error(Vec3f a, Vec3f b);

/// Returns the score of a block of these colors, at least 0, or -1 if the error of a color is above
/// the threshold. Scores order the merges of blocks: two colors score more if they are alike, more
/// colors if their mean square error is small.
float line_score(std::span<const Vec3f> colors, int weight_bits, float error_threshold);

}  // namespace voxdag::lab
