#include "voxdag/cpu/render_image.hpp"

#include <tbb/task_arena.h>

#include "voxdag/cpu/packet_caster.hpp"
#include "voxdag/cpu/post_filter.hpp"
#include "voxdag/cpu/streamed_image.hpp"
#include "voxdag/cpu/tile_renderer.hpp"
#include "voxdag/render/render_plan.hpp"

namespace voxdag {
namespace {

RenderedImage finish(RenderPlan& plan, const RenderOptions& options, const ViewSource* source) {
  if (options.filter && source == nullptr) {
    RenderedImage& image = plan.image();
    image.radiance = filter_picture(
        {image.radiance.data(), image.cell_pixels.data(), image.width, image.height});
  }
  return plan.finish();
}

}  // namespace

RenderedImage render_image(const CpuScene& scene, const Grid& grid, const RenderOptions& options,
                           Progress* progress, const ViewSource* source) {
  RenderPlan plan(scene.voxels(), grid, options);
  const std::vector<ViewTile> tiles = make_tiles(options.width, options.height, options.tile_size);
  plan.image().rays = scene.visit([&](const auto& nodes, const auto& caster) {
    const TileRenderer renderer(nodes, caster, plan.setup(), options.beams, source);
    const std::uint64_t rays = renderer.render(tiles, progress);
    if (options.with_steps) renderer.count();
    return rays;
  });
  return finish(plan, options, source);
}

RenderedImage render_streamed(BlockSource& source, const Grid& grid, const RenderOptions& options,
                              const std::function<void(const RenderedImage&)>& on_pass,
                              Progress* progress) {
  RenderOptions pass_options = options;
  const std::vector<ViewTile> tiles = make_tiles(options.width, options.height, options.tile_size);
  std::uint64_t rays = 0;
  for (;;) {
    RenderPlan plan(source.view(), grid, pass_options);
    // What is not said of the view is found once, so that all passes show the same.
    pass_options.view = {plan.image().view.eye, plan.image().view.target, plan.image().view.up,
                         plan.image().view.vertical_fov_degrees};
    const Vec3d eye = plan.image().view.eye;
    const StreamedNodes nodes(source.view(), source.listener());
    const TileRenderer renderer(nodes, PacketCaster(nodes), plan.setup(), options.beams, nullptr);
    rays += renderer.render(tiles, progress);
    const BlockSource::Loaded loaded = source.load_missing(eye, false);
    if (loaded.missed > 0 && loaded.loaded > 0) {
      if (on_pass) on_pass(finish(plan, options, nullptr));
      continue;
    }
    if (loaded.missed > 0) {
      const auto at_once = static_cast<std::size_t>(tbb::this_task_arena::max_concurrency());
      for (std::size_t begin = 0; begin < tiles.size(); begin += at_once) {
        const std::span<const ViewTile> part =
            std::span(tiles).subspan(begin, std::min(at_once, tiles.size() - begin));
        source.begin_part();
        do {
          rays += renderer.render(part, nullptr);
        } while (source.load_missing(eye, true).loaded > 0);
        if (progress == nullptr) continue;
        progress->throw_if_cancelled();
        progress->report("stream", static_cast<double>(begin) / static_cast<double>(tiles.size()),
                         rays);
      }
    }
    if (options.with_steps) renderer.count();
    plan.image().rays = rays;
    return finish(plan, options, nullptr);
  }
}

}  // namespace voxdag
