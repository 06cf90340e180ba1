#include "voxdag/cuda/check.hpp"
#include "voxdag/cuda/trace_kernels.hpp"
#include "voxdag/trace/cast.hpp"
#include "voxdag/trace/svdag_nodes.hpp"

namespace voxdag {
namespace {

constexpr std::uint32_t kThreads = 128;

template <class Nodes>
__global__ void __launch_bounds__(kThreads)
    closest_hits_kernel(Nodes nodes, Grid grid, const Ray* rays, Hit* hits, std::uint32_t count) {
  const std::uint32_t i = blockIdx.x * kThreads + threadIdx.x;
  if (i < count) hits[i] = closest_hit(nodes, grid, rays[i]);
}

}  // namespace

void launch_closest_hits(const SvdagView& dag, const Grid& grid, const Ray* rays, Hit* hits,
                         std::uint32_t count, cudaStream_t stream) {
  if (count == 0) return;
  closest_hits_kernel<<<(count + kThreads - 1) / kThreads, kThreads, 0, stream>>>(
      SvdagNodes(dag), grid, rays, hits, count);
  check_cuda(cudaGetLastError(), "casting rays");
}

}  // namespace voxdag
