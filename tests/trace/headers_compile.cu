// The traversal instantiated in a kernel: that it compiles as device code is the test.
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {

__global__ void cast_kernel(SvdagView dag, Grid grid, const Ray* rays, Hit* hits, bool* occluded,
                            std::size_t count) {
  const std::size_t i = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (i >= count) return;
  const SvdagNodes nodes(dag);
  hits[i] = closest_hit(nodes, grid, rays[i]);
  const auto stop = [](int level, float, float) { return level == 8; };
  occluded[i] = any_hit(nodes, grid, rays[i], stop);
}

}  // namespace voxdag
