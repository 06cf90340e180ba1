#pragma once
/// Smooths what voxels larger than pixels leave of a picture: blocks of one colour.
///
/// Source: Laine, Karras, "Efficient Sparse Voxel Octrees", I3D 2010, Section 4.3 and Figure 11.
/// Each pixel is averaged over a disc of its voxel's size, which shrinks to the sizes of the
/// voxels that it meets on its way from the centre: so regions of different sizes agree where they
/// touch, and what shows no voxel, whose size is one pixel, neither blurs nor bleeds.
#include <array>
#include <cstddef>

#include "voxdag/core/vec.hpp"
#include "voxdag/render/cell_pixels.hpp"

namespace voxdag {

inline constexpr int kFilterSamples = 96;
inline constexpr float kFilterRadius = 24.0f;  ///< Pixels.

/// A pixel to look at, relative to the one that is filtered.
struct FilterSample {
  int x, y;
  float distance;  ///< Of (x, y) from zero.
  float weight;    ///< Pixels of the disc that lie nearer to it than to other samples.
};

/// By distance, the first at zero. All others but one have their opposites: a filter moves nothing.
using FilterTable = std::array<FilterSample, kFilterSamples>;

/// The one table there is: the density of its samples falls as the square root of the distance.
const FilterTable& filter_table();

/// What is filtered: width * height values each, rows from top to bottom.
struct FilterInput {
  const Vec3f* color = nullptr;
  const std::uint8_t* cell_pixels = nullptr;  ///< See pack_cell_pixels().
  int width = 0, height = 0;
};

/// The filtered colour of a pixel. `samples` are those of a FilterTable. What lies outside the
/// picture is left out.
VOXDAG_HD inline Vec3f filtered_color(const FilterInput& input, const FilterSample* samples,
                                      int pixel_x, int pixel_y) {
  const auto index = [&input](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(input.width) +
           static_cast<std::size_t>(x);
  };
  const std::size_t center = index(pixel_x, pixel_y);
  float radius = unpack_cell_pixels(input.cell_pixels[center]);
  if (radius <= 1.0f) return input.color[center];
  Vec3f sum{};
  float weight_sum = 0.0f;
  for (int i = 0; i < kFilterSamples; ++i) {
    const FilterSample& sample = samples[i];
    if (sample.distance > radius) break;
    const int x = pixel_x + sample.x, y = pixel_y + sample.y;
    if (x < 0 || y < 0 || x >= input.width || y >= input.height) continue;
    const std::size_t at = index(x, y);
    const float other = unpack_cell_pixels(input.cell_pixels[at]);
    radius = other < radius ? other : radius;
    if (sample.distance > radius) break;
    const float taper = radius - sample.distance;
    const float weight = sample.weight * (taper < 1.0f ? taper : 1.0f);
    sum = sum + input.color[at] * weight;
    weight_sum += weight;
  }
  return sum * (1.0f / weight_sum);
}

}  // namespace voxdag
