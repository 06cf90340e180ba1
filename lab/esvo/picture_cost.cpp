#include "lab/esvo/picture_cost.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "voxdag/cpu/post_filter.hpp"
#include "voxdag/cpu/render_image.hpp"
#include "voxdag/cuda/render_image.hpp"

namespace voxdag::lab {
namespace {

/// Returns the seconds of the fastest of `repeat` calls, after a first one that does not count.
template <class Work>
double fastest_seconds(int repeat, const Work& work) {
  using Clock = std::chrono::steady_clock;
  double fastest = HUGE_VAL;
  for (int turn = 0; turn <= repeat; ++turn) {
    const Clock::time_point start = Clock::now();
    work();
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    if (turn > 0) fastest = std::min(fastest, seconds);
  }
  return fastest;
}

}  // namespace

PictureCost picture_cost(const EsvoFile& esvo, const DeviceScene* on_device,
                         std::span<const View> views, ImageSize size, float lod_pixels,
                         int repeat) {
  PictureCost sum;
  for (const View& view : views) {
    RenderOptions options;
    options.width = size.width;
    options.height = size.height;
    options.view = {view.eye, view.target, view.up, view.vertical_fov_degrees};
    options.lod_pixels = lod_pixels;
    options.shadows = false;
    options.occlusion_samples = 0;
    options.with_normal = options.with_occlusion = options.with_shadow = false;
    if (on_device != nullptr) {
      const auto seconds = [&](FilterKind filter) {
        options.filter = filter;
        return fastest_seconds(repeat, [&] { render_image(*on_device, esvo.grid(), options); });
      };
      const double picture = seconds(FilterKind::kNone);
      sum.picture += picture;
      sum.filter += seconds(FilterKind::kGuided) - picture;
      continue;
    }
    options.filter = FilterKind::kGuided;
    RenderedImage image = render_image(esvo.view(), esvo.grid(), options);
    const Camera camera = make_camera(image.view, image.width, image.height);
    sum.filter += fastest_seconds(repeat, [&] {
      filter_picture(filter_input(buffers_of(image), camera, FilterKind::kGuided));
    });
    options.filter = FilterKind::kNone;
    sum.picture +=
        fastest_seconds(repeat, [&] { image = render_image(esvo.view(), esvo.grid(), options); });
  }
  if (!(sum.filter > 0)) sum.filter = NAN;
  return sum;
}

}  // namespace voxdag::lab
