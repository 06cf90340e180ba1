// Instantiates the renderer in kernels. The test is that it compiles as device code.
#include "voxdag/render/count_steps.hpp"
#include "voxdag/render/post_filter.hpp"
#include "voxdag/render/render_tile.hpp"
#include "voxdag/render/tone_map.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {

__global__ void beam_kernel(SvdagView dag, RenderSetup setup, float* starts) {
  const int x = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x) * kCoarseBeamPixels;
  const int y = static_cast<int>(blockIdx.y * blockDim.y + threadIdx.y) * kCoarseBeamPixels;
  if (x >= setup.camera.width || y >= setup.camera.height) return;
  set_beam_starts(SvdagNodes(dag), setup, x, y, starts);
  count_steps(SvdagNodes(dag), setup, x, y);
}

__global__ void render_kernel(SvdagView dag, RenderSetup setup) {
  ViewTile tile;
  tile.x = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  tile.y = static_cast<int>(blockIdx.y * blockDim.y + threadIdx.y);
  tile.width = tile.height = 1;
  if (tile.x >= setup.camera.width || tile.y >= setup.camera.height) return;
  const SvdagNodes nodes(dag);
  const ScalarCaster<SvdagNodes> caster(nodes);
  TileScratch<1> scratch;
  render_tile(nodes, caster, setup, tile, scratch, [&](const ViewTile& at, TileScratch<1>& out) {
    return trace_view_samples(nodes, caster, setup, at, out);
  });
}

__global__ void filter_kernel(FilterInput input, const FilterSample* samples, Vec3f* filtered) {
  const int x = static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
  const int y = static_cast<int>(blockIdx.y * blockDim.y + threadIdx.y);
  if (x < input.width && y < input.height)
    filtered[y * input.width + x] = filtered_color(input, samples, x, y);
}

}  // namespace voxdag
