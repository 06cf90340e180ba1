#include "voxdag/cpu/render_image.hpp"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cmath>

#include "voxdag/parallel/parallel_for.hpp"
#include "voxdag/render/tone_map.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {
namespace {

constexpr int kTileSize = 32;

/// Where sample i of a pixel lies in it: the centre, then the R2 sequence around it (M. Roberts,
/// "The Unreasonable Effectiveness of Quasirandom Sequences", 2018).
void sample_offset(int i, double& x, double& y) {
  x = 0.5 + i * 0.7548776662466927;
  y = 0.5 + i * 0.5698402909980532;
  x -= std::floor(x);
  y -= std::floor(y);
}

void check(const RenderOptions& options) {
  constexpr int kMaxSide = 1 << 16;
  if (options.width < 1 || options.height < 1 || options.width > kMaxSide ||
      options.height > kMaxSide)
    throw Error("a picture has 1 to 65536 pixels a side");
  if (options.samples_per_pixel < 1) throw Error("a picture has at least 1 sample per pixel");
  if (options.sun) {
    const double length2 = dot(*options.sun, *options.sun);
    if (!(length2 > 0 && length2 < HUGE_VAL)) throw Error("the sun needs a direction");
  }
}

/// Without a direction, the sun is where it models what the camera looks at.
Sky make_sky(const Camera& camera, const View& view, const std::optional<Vec3d>& sun) {
  Sky sky;
  const Vec3d up = normalized(view.up);
  const Vec3d right = normalized(camera.right);
  const Vec3d back = cross(right, up);
  sky.up = static_cast<Vec3f>(up);
  sky.sun = static_cast<Vec3f>(normalized(sun.value_or(up * 0.9 - right * 0.6 + back * 0.25)));
  sky.fill = static_cast<Vec3f>(right);
  return sky;
}

/// The factor that gives the picture's surfaces a middling brightness, from a sparse grid of
/// samples. Between what suits a sunlit object and what a closed room needs.
float automatic_exposure(const SvdagNodes& nodes, const Grid& grid, const Camera& camera,
                         const Sky& sky, const ShadeOptions& options) {
  constexpr int kColumns = 48, kRows = 32;
  constexpr float kMiddle = 0.33f, kLeast = 0.42f, kMost = 0.9f;
  double sum = 0;
  int count = 0;
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) {
      const Sample sample =
          shade_sample(nodes, grid, camera, sky, options, (column + 0.5) * camera.width / kColumns,
                       (row + 0.5) * camera.height / kRows);
      if (std::isinf(sample.depth)) continue;
      sum +=
          std::log(static_cast<double>(dot(sample.radiance, {0.2126f, 0.7152f, 0.0722f})) + 1e-3);
      ++count;
    }
  if (count == 0) return kLeast;
  return std::clamp(kMiddle / static_cast<float>(std::exp(sum / count)), kLeast, kMost);
}

}  // namespace

RenderedImage render_image(const SvdagView& dag, const Grid& grid, const RenderOptions& options,
                           Progress* progress) {
  check(options);
  assert(grid.levels == dag.levels);
  const int width = options.width, height = options.height;
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  RenderedImage image;
  image.width = width;
  image.height = height;
  image.view = frame_scene(dag, grid, static_cast<double>(width) / height, options.view);
  image.rgb.resize(pixels);
  image.depth.resize(pixels);
  image.normal.resize(pixels);

  const Camera camera = make_camera(image.view, width, height);
  const Sky sky = make_sky(camera, image.view, options.sun);
  const SvdagNodes nodes(dag);
  const float exposure = options.shade.exposure > 0
                             ? options.shade.exposure
                             : automatic_exposure(nodes, grid, camera, sky, options.shade);
  const auto render_pixel = [&](int x, int y) {
    const std::size_t at =
        static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
    Vec3f sum{};
    std::uint64_t rays = 0;
    for (int i = 0; i < options.samples_per_pixel; ++i) {
      double dx, dy;
      sample_offset(i, dx, dy);
      const Sample sample = shade_sample(nodes, grid, camera, sky, options.shade, x + dx, y + dy);
      // Averaging what the display will show keeps the edges of bright things smooth.
      sum = sum + tone_map(sample.radiance * exposure);
      rays += static_cast<std::uint64_t>(sample.rays);
      if (i > 0) continue;
      image.depth[at] = sample.depth;
      image.normal[at] = sample.normal;
    }
    image.rgb[at] = sum * (1.0f / static_cast<float>(options.samples_per_pixel));
    return rays;
  };

  const int tiles_x = (width + kTileSize - 1) / kTileSize;
  const int tiles_y = (height + kTileSize - 1) / kTileSize;
  const std::size_t tiles = static_cast<std::size_t>(tiles_x) * static_cast<std::size_t>(tiles_y);
  std::atomic<std::uint64_t> rays{0};
  std::atomic<std::size_t> done{0};
  parallel_for(tiles, [&](std::size_t tile) {
    if (progress != nullptr && progress->cancelled()) return;
    const int x0 = static_cast<int>(tile % static_cast<std::size_t>(tiles_x)) * kTileSize;
    const int y0 = static_cast<int>(tile / static_cast<std::size_t>(tiles_x)) * kTileSize;
    std::uint64_t tile_rays = 0;
    for (int y = y0; y < std::min(y0 + kTileSize, height); ++y)
      for (int x = x0; x < std::min(x0 + kTileSize, width); ++x) tile_rays += render_pixel(x, y);
    const std::uint64_t rays_so_far = rays.fetch_add(tile_rays) + tile_rays;
    const std::size_t tiles_so_far = done.fetch_add(1) + 1;
    if (progress != nullptr)
      progress->report("render", static_cast<double>(tiles_so_far) / static_cast<double>(tiles),
                       rays_so_far);
  });
  if (progress != nullptr) progress->throw_if_cancelled();
  image.rays = rays;
  return image;
}

}  // namespace voxdag
