// Instantiates the traversal in a kernel. The test is that it compiles as device code.
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/compact_svdag_nodes.hpp"
#include "voxdag/trace/esvo_cast.hpp"
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

__global__ void esvo_kernel(EsvoView esvo, Grid grid, const Ray* rays, Hit* hits, bool* occluded,
                            std::size_t count) {
  const std::size_t i = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (i >= count) return;
  hits[i] = closest_hit(ContourNodes(esvo), grid, rays[i]);
  occluded[i] = any_hit(EsvoNodes(esvo), grid, rays[i]);
}

__global__ void compact_kernel(CompactSvdagView dag, Grid grid, const Ray* rays, Hit* hits,
                               std::size_t count) {
  const std::size_t i = std::size_t{blockIdx.x} * blockDim.x + threadIdx.x;
  if (i >= count) return;
  LastDecoded cache;
  hits[i] = closest_hit(CompactSvdagNodes<LastDecoded>(dag, cache), grid, rays[i]);
}

}  // namespace voxdag
