#include "voxdag/cpu/post_filter.hpp"

#include "voxdag/core/parallel/parallel_for.hpp"

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

void filter_picture(RenderedImage& image, FilterKind kind) {
  if (kind == FilterKind::kNone) return;
  const Camera camera = make_camera(image.view, image.width, image.height);
  image.radiance = filter_picture(filter_input(buffers_of(image), camera, kind));
}

}  // namespace voxdag
