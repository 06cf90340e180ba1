#include "voxdag/cpu/render_image.hpp"

#include <utility>

#include "voxdag/cpu/packets/packet_caster.hpp"
#include "voxdag/cpu/post_filter.hpp"
#include "voxdag/cpu/tile_renderer.hpp"
#include "voxdag/render/render_plan.hpp"

namespace voxdag {
namespace {

/// Filters the picture if the options ask for it, exposes it and tone maps it.
RenderedImage finish(const RenderPlan& plan, RenderedImage image, const RenderOptions& options,
                     const ViewSource* source) {
  if (source == nullptr) filter_picture(image, options.filter);
  return plan.finish(std::move(image));
}

}  // namespace

RenderedImage render_image(const CpuScene& scene, const Grid& grid, const RenderOptions& options,
                           Work work, const ViewSource* source) {
  RenderPlan plan(scene.voxels(), grid, options);
  const std::vector<ViewTile> tiles = make_tiles(options.width, options.height, options.tile_size);
  plan.image().rays = scene.visit([&](const auto& nodes, const auto& caster) {
    const TileRenderer renderer(nodes, caster, plan.setup(), options.beams, source);
    const std::uint64_t rays = renderer.render(tiles, work);
    if (options.with_steps) renderer.count();
    return rays;
  });
  return finish(plan, std::move(plan.image()), options, source);
}

}  // namespace voxdag
