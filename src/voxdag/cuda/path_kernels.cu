#include "voxdag/cuda/launch.hpp"
#include "voxdag/cuda/render_kernel.hpp"
#include "voxdag/cuda/render_kernels.hpp"
#include "voxdag/cuda/with_nodes.hpp"

namespace voxdag {

void launch_paths(const DeviceVoxels& voxels, const RenderSetup& setup, const LaunchRange& range,
                  const ViewSample* view_samples, unsigned long long* rays, cudaStream_t stream) {
  // A grid above the DAG gives the same hits, and would be one more kernel to compile.
  with_beam_nodes(voxels, [&]<class Nodes>(const Nodes& nodes) {
    launch("tracing paths",
           render_kernel<TileScratch<1, PathScratch<1>>, Nodes, ScalarCaster<Nodes>>,
           range.last_block - range.first_block, kBlockPixels, stream, nodes, ScalarCaster(nodes),
           setup, range, view_samples, rays);
  });
}

}  // namespace voxdag
