#pragma once
/// What the CPU finds and renders at an ESVO as cubes: the reference for DeviceLayout::kCubes.
#include <span>
#include <vector>

#include "voxdag/cpu/post_filter.hpp"
#include "voxdag/cpu/tile_renderer.hpp"
#include "voxdag/render/render_plan.hpp"
#include "voxdag/trace/esvo_cast.hpp"

namespace voxdag {

inline std::vector<Hit> trace_cubes(const EsvoView& esvo, const Grid& grid,
                                    std::span<const Ray> rays) {
  std::vector<Hit> hits;
  for (const Ray& ray : rays) hits.push_back(closest_hit(EsvoNodes(esvo), grid, ray));
  return hits;
}

inline RenderedImage render_cubes(const EsvoView& esvo, const Grid& grid,
                                  const RenderOptions& options,
                                  const ViewSource* source = nullptr) {
  RenderPlan plan(esvo, grid, options);
  const EsvoNodes nodes(esvo);
  const TileRenderer renderer(nodes, ScalarCaster(nodes), plan.setup(), options.beams, source);
  plan.image().rays =
      renderer.render(make_tiles(options.width, options.height, options.tile_size), {});
  if (options.with_steps) renderer.count();
  if (source == nullptr) filter_picture(plan.image(), options.filter);
  return plan.finish();
}

}  // namespace voxdag
