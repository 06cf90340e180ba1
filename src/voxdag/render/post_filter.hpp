#pragma once
/// A filter that smooths voxels larger than pixels. Without it they would be blocks of one colour.
///
/// Source: Laine and Karras, "Efficient Sparse Voxel Octrees", I3D 2010, section 4.3 and Figure 11.
/// Each pixel becomes the average of a disc of its voxel's size. The disc shrinks to the sizes of
/// the voxels that it covers, from the centre outwards. So regions of different sizes agree at
/// their borders. Pixels without a voxel have a size of one pixel: they stay sharp, and their
/// colour does not spread. The naive filter, the left half of Figure 10, does not shrink the disc.
///
/// The guided filter does more than the paper's. The paper's pictures had no shadows, and its
/// voxels are small at outlines. Here one voxel may cover a flat wall up to its edge. So the
/// average leaves out pixels of other surfaces and pixels in other light.
#include <array>
#include <cstddef>

#include "voxdag/core/vec.hpp"
#include "voxdag/render/camera.hpp"
#include "voxdag/render/cell_pixels.hpp"
#include "voxdag/render/filter_kind.hpp"
#include "voxdag/render/render_setup.hpp"

namespace voxdag {

inline constexpr int kFilterSamples = 96;
inline constexpr float kFilterRadius = 24.0f;  ///< Pixels.

/// A pixel of the disc, relative to its centre.
struct FilterSample {
  int x, y;
  float distance;  ///< Distance from (0, 0).
  float weight;    ///< Number of the disc's pixels that are closest to this sample.
};

/// The samples of the disc, sorted by distance; the first is the centre. All others but one come in
/// opposite pairs, so that the filter does not shift the picture.
using FilterTable = std::array<FilterSample, kFilterSamples>;

/// Returns the table. The density of its samples falls with the square root of the distance.
const FilterTable& filter_table();

/// The buffers that distinguish surfaces and light; see ImageBuffers.
struct FilterGuides {
  const float* depth = nullptr;  ///< Null: there are no guides.
  const Vec3f* normal = nullptr;
  const float* occlusion = nullptr;
  const float* shadow = nullptr;
  Camera camera;
};

/// The picture to filter. Each buffer has width * height values, rows from top to bottom.
struct FilterInput {
  const Vec3f* color = nullptr;
  const std::uint8_t* cell_pixels = nullptr;  ///< See pack_cell_pixels().
  int width = 0, height = 0;
  FilterGuides guides{};
  bool shrinks = true;  ///< The disc shrinks to the sizes of the voxels that it covers.
  /// See ImageBuffers: `color` holds the light of surfaces alone, times this. Null: 1 everywhere.
  const float* coverage = nullptr;
};

/// Returns a picture's buffers, for a filter of this kind. `image` must have all buffers but the
/// steps; `kind` must not be kNone.
VOXDAG_HD inline FilterInput filter_input(const ImageBuffers& image, const Camera& camera,
                                          FilterKind kind) {
  FilterInput input{image.radiance, image.cell_pixels, camera.width, camera.height};
  if (kind == FilterKind::kGuided)
    input.guides = {image.depth, image.normal, image.occlusion, image.shadow, camera};
  input.shrinks = kind != FilterKind::kNaive;
  input.coverage = image.coverage;
  return input;
}

/// Decides whether a pixel shows the surface that a given pixel shows, in equal light.
class SameSurface {
 public:
  /// Sets the given pixel: (x, y), with index `at`, whose voxel has a side of `pixels` pixels.
  VOXDAG_HD SameSurface(const FilterGuides& guides, int x, int y, std::size_t at, float pixels)
      : guides_(guides), center_(at) {
    if (guides.depth == nullptr) return;
    // Tolerances for the steps between contours, and for the sample's position in its pixel.
    constexpr double kPixels = 1.0, kCells = 0.25;
    const auto depth = static_cast<double>(guides.depth[at]);
    normal_ = static_cast<Vec3d>(guides.normal[at]);
    plane_ = dot(normal_, guides.camera.direction(x + 0.5, y + 0.5)) * depth;
    tolerance_ =
        (kPixels + kCells * static_cast<double>(pixels)) * guides.camera.pixel_size() * depth;
  }

  /// Returns whether the pixel (x, y), with index `at`, shows that surface in equal light.
  VOXDAG_HD bool has(int x, int y, std::size_t at) const {
    constexpr float kNormal = 0.9f, kLight = 0.2f;  // cosine; fraction of the light
    if (guides_.depth == nullptr || at == center_) return true;
    const auto differ = [&](const float* part) {
      return std::fabs(part[at] - part[center_]) > kLight;
    };
    if (differ(guides_.occlusion) || differ(guides_.shadow)) return false;
    if (!(dot(guides_.normal[at], guides_.normal[center_]) > kNormal)) return false;
    const double plane = dot(normal_, guides_.camera.direction(x + 0.5, y + 0.5)) *
                         static_cast<double>(guides_.depth[at]);
    return std::fabs(plane - plane_) <= tolerance_;
  }

 private:
  const FilterGuides& guides_;
  std::size_t center_;
  Vec3d normal_{};
  double plane_ = 0, tolerance_ = 0;  ///< Distance of the surface's plane from the eye.
};

/// Returns the filtered colour of a pixel, times its coverage. `samples` is a FilterTable's data.
/// Ignores samples outside the picture and those without a voxel.
VOXDAG_HD inline Vec3f filtered_color(const FilterInput& input, const FilterSample* samples,
                                      int pixel_x, int pixel_y) {
  const auto index = [&input](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(input.width) +
           static_cast<std::size_t>(x);
  };
  const std::size_t center = index(pixel_x, pixel_y);
  float radius = unpack_cell_pixels(input.cell_pixels[center]);
  if (radius <= 1.0f) return input.color[center];
  const SameSurface same(input.guides, pixel_x, pixel_y, center, radius);
  // A pixel with at most one similar neighbour is noise: it is averaged with all neighbours.
  constexpr int kFewest = 2;
  int alike = 0;
  for (int i = 0; i < 9 && alike < kFewest; ++i) {
    const int x = pixel_x + i % 3 - 1, y = pixel_y + i / 3 - 1;
    const bool is_neighbour = i != 4 && x >= 0 && y >= 0 && x < input.width && y < input.height;
    alike += is_neighbour && same.has(x, y, index(x, y)) ? 1 : 0;
  }
  Vec3f sum{};
  float weight_sum = 0.0f;
  for (int i = 0; i < kFilterSamples; ++i) {
    const FilterSample& sample = samples[i];
    if (sample.distance > radius) break;
    const int x = pixel_x + sample.x, y = pixel_y + sample.y;
    if (x < 0 || y < 0 || x >= input.width || y >= input.height) continue;
    const std::size_t at = index(x, y);
    if (input.shrinks) {
      const float other = unpack_cell_pixels(input.cell_pixels[at]);
      radius = other < radius ? other : radius;
      if (sample.distance > radius) break;
    }
    const float taper = radius - sample.distance;
    const float weight = sample.weight * (taper < 1.0f ? taper : 1.0f);
    if (alike >= kFewest && !same.has(x, y, at)) continue;
    if (input.coverage != nullptr && input.cell_pixels[at] == 0) continue;
    sum = sum + input.color[at] * weight;
    weight_sum += weight * (input.coverage == nullptr ? 1.0f : input.coverage[at]);
  }
  const float coverage = input.coverage == nullptr ? 1.0f : input.coverage[center];
  return sum * (coverage / weight_sum);
}

}  // namespace voxdag
