#include "voxdag/cuda/trace_batch.hpp"

#include <algorithm>
#include <array>
#include <cassert>

#include "voxdag/cuda/memory.hpp"
#include "voxdag/cuda/stream.hpp"
#include "voxdag/cuda/trace_kernels.hpp"

namespace voxdag {
namespace {

constexpr std::size_t kBlock = std::size_t{1} << 18;

}  // namespace

/// A block of rays. It is being copied to the device, traced, or its hits are being copied back.
struct RayBlock {
  RayBlock()
      : rays(make_pinned_buffer<Ray>(kBlock, "rays")),
        hits(make_pinned_buffer<Hit>(kBlock, "hits")),
        device_rays(make_device_buffer<Ray>(kBlock, "rays")),
        device_hits(make_device_buffer<Hit>(kBlock, "hits")) {}

  PinnedBuffer<Ray> rays;
  PinnedBuffer<Hit> hits;
  DeviceBuffer<Ray> device_rays;
  DeviceBuffer<Hit> device_hits;
  std::size_t begin = 0, count = 0;  // range in all rays; count is 0 if the block is free
  CudaStream stream;                 // last, so that it is destroyed before the memory that it uses
};

struct CudaTracer::State {
  State(const DeviceScene& dag_in, const Grid& grid_in) : dag(dag_in), grid(grid_in) {}

  void send(RayBlock& block, std::span<const Ray> rays) const {
    std::copy(rays.begin(), rays.end(), block.rays.data());
    const cudaStream_t stream = block.stream.get();
    check_cuda(cudaMemcpyAsync(block.device_rays.data(), block.rays.data(), rays.size_bytes(),
                               cudaMemcpyHostToDevice, stream),
               "copying rays to the device");
    launch_closest_hits(dag.view(), grid, block.device_rays.data(), block.device_hits.data(),
                        static_cast<std::uint32_t>(rays.size()), stream);
    check_cuda(cudaMemcpyAsync(block.hits.data(), block.device_hits.data(),
                               rays.size() * sizeof(Hit), cudaMemcpyDeviceToHost, stream),
               "copying hits from the device");
  }

  static void receive(RayBlock& block, std::span<Hit> hits) {
    block.stream.wait("casting rays");
    std::copy_n(block.hits.data(), block.count, hits.data() + block.begin);
    block.count = 0;
  }

  DeviceScene dag;
  Grid grid;
  std::array<RayBlock, 2> blocks;
};

CudaTracer::CudaTracer(const DeviceScene& dag, const Grid& grid) {
  assert(grid.levels == dag.host().levels());
  dag.make_current();
  state_ = std::make_shared<State>(dag, grid);
}

void CudaTracer::trace(std::span<const Ray> rays, std::span<Hit> hits, Work work) const {
  assert(rays.size() == hits.size());
  state_->dag.make_current();
  std::size_t turn = 0;
  const auto next = [&]() -> RayBlock& { return state_->blocks[turn++ % state_->blocks.size()]; };
  for (RayBlock& block : state_->blocks) {
    // A cancelled call may have left work in the stream.
    block.stream.wait("casting rays");
    block.count = 0;
  }
  for (std::size_t begin = 0; begin < rays.size(); begin += kBlock) {
    work.poll();
    RayBlock& block = next();
    if (block.count > 0) state_->receive(block, hits);
    block.begin = begin;
    block.count = std::min(kBlock, rays.size() - begin);
    state_->send(block, rays.subspan(begin, block.count));
    work.report_done("trace", begin, rays.size());
  }
  for (std::size_t i = 0; i < state_->blocks.size(); ++i)
    if (RayBlock& block = next(); block.count > 0) state_->receive(block, hits);
}

}  // namespace voxdag
