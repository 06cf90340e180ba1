#include "voxdag/cpu/stream/streamed_tiles.hpp"

#include "voxdag/cpu/post_filter.hpp"

namespace voxdag {
namespace {

/// Renders all tiles; calls `on_pass` after each pass but the last.
template <class OnPass>
void render_all(BlockSource& source, StreamedTiles& tiles, Vec3d eye, const OnPass& on_pass) {
  source.begin_part();
  std::vector<ViewTile> left = tiles.all();
  for (;;) {
    tiles.begin_pass();
    left = tiles.render(left, "render");
    const std::size_t loaded = source.load_missing(eye);
    if (left.empty()) return;
    if (loaded == 0) return tiles.render_rest(left);
    on_pass();
  }
}

}  // namespace

RenderedImage render_passes(BlockSource& source, StreamedTiles& tiles, const RenderPlan& plan,
                            const RenderOptions& options,
                            const std::function<void(const RenderedImage&)>& on_pass) {
  const auto finished = [&](RenderedImage image) {
    filter_picture(image, options.filter);
    return plan.finish(std::move(image));
  };
  render_all(source, tiles, plan.setup().camera.eye, [&] {
    if (on_pass) on_pass(finished(tiles.image()));
  });
  if (options.with_steps) tiles.count_steps();
  return finished(tiles.take_image());
}

}  // namespace voxdag
