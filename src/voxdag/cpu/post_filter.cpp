#include "voxdag/cpu/post_filter.hpp"

#include "voxdag/parallel/parallel_for.hpp"

namespace voxdag {

std::vector<Vec3f> filter_picture(const FilterInput& input) {
  const FilterTable& table = filter_table();
  const auto width = static_cast<std::size_t>(input.width);
  const auto height = static_cast<std::size_t>(input.height);
  std::vector<Vec3f> filtered(width * height);
  parallel_for(height, [&](std::size_t y) {
    for (std::size_t x = 0; x < width; ++x)
      filtered[y * width + x] =
          filtered_color(input, table.data(), static_cast<int>(x), static_cast<int>(y));
  });
  return filtered;
}

FilterInput filter_input(const RenderedImage& image) {
  return {image.radiance.data(),
          image.cell_pixels.data(),
          image.width,
          image.height,
          {image.depth.data(), image.normal.data(), image.occlusion.data(), image.shadow.data(),
           make_camera(image.view, image.width, image.height)}};
}

void filter_picture(RenderedImage& image) { image.radiance = filter_picture(filter_input(image)); }

}  // namespace voxdag
